/// A statement about two methods that a sweep can confirm or refute: the contents of a claim file.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace loopbench::harness {

enum class ClaimAnswer { holds, does_not_hold, cannot_tell };
inline auto choices(ClaimAnswer) {
  return std::array{std::pair{"holds", ClaimAnswer::holds},
                    std::pair{"does not hold", ClaimAnswer::does_not_hold},
                    std::pair{"cannot tell", ClaimAnswer::cannot_tell}};
}

/// One answer to the claim. Numbers are those of the method relative to the baseline.
struct Look {
  std::string date;    ///< 2026-11-25
  std::string commit;  ///< of the program
  double level = 0.0;  ///< of its interval: 1 - level
  ClaimAnswer answer = ClaimAnswer::cannot_tell;
  double ratio = 1.0;  ///< typical ratio; with mean, wins and losses it identifies the results
  double low = 0.0;    ///< ends of its interval; 0 and infinity if there are too few groups
  double high = 0.0;
  double mean = 1.0;  ///< geometric mean ratio; NaN: none
  std::size_t wins = 0;
  std::size_t losses = 0;
};

/// "The error of `method` is at most 1 - margin times that of `baseline`." A negative margin
/// claims that it is not much worse.
struct Claim {
  std::filesystem::path file;
  std::string statement;  ///< in words, for readers
  std::string config;     ///< path relative to the claim file, or the name of an installed config
  std::string method;
  std::string baseline;
  std::string metric = "ate";
  std::vector<std::string> where;  ///< filters that leave one score, see model/where.hpp
  std::string value = "rmse";      ///< statistic
  std::string over = "groups";     ///< unit of observation
  double margin = 0.0;             ///< share, below 1
  double alpha = 0.05;             ///< probability of a false answer, over all looks
  ClaimAnswer expected = ClaimAnswer::holds;
  /// Name of each sequence -> hash of the definitions of its runs, see tables/claim_store.hpp.
  std::map<std::string, std::string> sequences;
  std::vector<Look> looks;
};

}  // namespace loopbench::harness

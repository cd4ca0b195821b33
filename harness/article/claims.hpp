/// The article's claims, checked with our results.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "harness/article/paper_run.hpp"

namespace loopbench::harness {

enum class Verdict { holds, does_not_hold, cannot_be_judged };
inline auto choices(Verdict) {
  return std::array{std::pair{"holds", Verdict::holds},
                    std::pair{"does not hold", Verdict::does_not_hold},
                    std::pair{"cannot be judged", Verdict::cannot_be_judged}};
}

struct Claim {
  std::string text;
  std::string where;  ///< sequence, input and reading used for the check
  Verdict verdict = Verdict::cannot_be_judged;
  std::string because;  ///< the decisive numbers
};

/// Checks one reading on the article's own input, the closed run: each ordering of tables 1 to 4,
/// the best N and M of text and tables, "the same level as a whole, better in some areas" and
/// "smoother". Two errors count as equal if they differ by less than `tie` of the larger.
std::vector<Claim> check_claims(const std::vector<PaperCell>& cells,
                                const std::string& reading,
                                double tie = 0.001);

/// A Markdown table.
std::string claim_table(const std::vector<Claim>& claims);

}  // namespace loopbench::harness

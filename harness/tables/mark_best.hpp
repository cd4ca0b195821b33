/// Selection of the best and second-best values in a table's column (or row).
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "harness/compare/ranking.hpp"

namespace loopbench::harness {

using RunSet = std::set<std::size_t>;  ///< numbers of runs

/// The values of one entry by run; nullopt if the method failed.
using ByRun = std::map<std::size_t, std::optional<double>>;

/// Removes the runs that are not in `others`.
inline void keep_only(RunSet& runs, const RunSet& others) {
  std::erase_if(runs, [&](std::size_t run) { return !others.contains(run); });
}

enum class Mark { none, second, best };

/// "best", "second" or "".
const char* mark_name(Mark mark);

/// Input of the comparison for marks.
struct MarkInput {
  std::vector<ByRun> competitors;
  std::vector<std::size_t> group;  ///< of each run
  metrics::Better better = metrics::Better::lower;
  double target = 0.0;
  std::vector<std::size_t> sequence = {};  ///< of each run; empty: not known
  bool is_paired = true;                   ///< false: independent runs of the sequences
};

struct Marks {
  std::vector<Mark> marks;  ///< one per competitor
  std::string why_none;     ///< set if no test was possible for any values
};

/// Best: the leading competitors by `rank_methods`, as in verdicts, if they are significantly
/// better than all others; second best: the same among the others. A competitor that lacks a run
/// without having failed on it is compared on the runs that it has, but never marked. Competitors
/// without values are ignored.
Marks mark_best(const MarkInput& input, const RankingOptions& options);

}  // namespace loopbench::harness

/// Which values of a table's column (or row) are marked as best and second best.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/compare/ranking.hpp"

namespace loopbench {

enum class Mark { none, second, best };

/// "best", "second" or "".
const char* mark_name(Mark mark);

/// The values that fell into one cell, by run; none where the method failed.
using ByRun = std::map<std::string, std::optional<double>>;

/// What is compared where the best is marked.
struct Lane {
  std::vector<ByRun> competitors;
  std::map<std::string, std::string> group;  ///< of a run; a group by itself where there is none
  Better better = Better::lower;
  double target = 0.0;
};

struct Marks {
  std::vector<Mark> marks;  ///< one for each competitor
  std::string why_none;     ///< set when nothing could be tested, whatever the values
};

/// Best: proven better than every other competitor by `rank_methods`, as verdicts have it; second
/// best: than all but the best. Methods that are equal share a mark. A competitor that lacks a run
/// without having failed on it is compared where all have one, but never marked. Competitors
/// without values do not compete.
Marks mark_best(const Lane& lane, const RankingOptions& options);

}  // namespace loopbench

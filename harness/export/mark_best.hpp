/// Who may be called best in a table.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace loopbench {

enum class Mark { none, second, best };

/// "best", "second" or "".
const char* mark_name(Mark mark);

/// The values that fell into one cell, by run: what is paired in a test.
using ByRun = std::map<std::string, double>;

struct Marks {
  std::vector<Mark> marks;  ///< one for each competitor
  std::string why_none;     ///< set when nothing could be tested, whatever the values
};

/// Best: the lowest mean, when a paired Wilcoxon test tells it from every other competitor at level
/// alpha, Holm-corrected over all pairs since it was picked by looking; second best: likewise among
/// the rest. A competitor that lacks a run which another has is compared where both have one, but
/// never marked. `higher` turns the order round. Competitors without values do not compete.
/// O(competitors^2) tests.
Marks mark_best(const std::vector<ByRun>& competitors, bool higher, double alpha);

}  // namespace loopbench

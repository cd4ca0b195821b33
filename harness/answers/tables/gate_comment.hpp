/// Reports of the gate for the comment of a CI system, which limits its length.
#pragma once

#include <string>

#include "harness/answers/gate/gate.hpp"

namespace loopbench::harness {

inline constexpr std::size_t kCommentCells = 20;  ///< listed in a comment

/// The verdict, notes, a table of all methods that have findings, and one line for each of the
/// kCommentCells worst cells: regressions first, then by their largest relative change. A report
/// of at most so many findings is complete, as markdown() prints it. At most about 30,000
/// characters: long names and texts are shortened. O(n log n) in the findings.
std::string comment(const GateReport& report, const std::string& sweep);

}  // namespace loopbench::harness

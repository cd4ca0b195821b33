/// Why numbers are missing from a table, said once.
#pragma once

#include <string>
#include <vector>

namespace loopbench {

/// One missing number, or all of a row when `what` is empty.
struct Missing {
  std::string row;
  std::string what;    ///< "ate rotation"
  std::string status;  ///< "declined", "undefined"
  std::string why;
};

/// A line for each reason, in the order they came: "ROWS: WHATS STATUS: WHY". What one row misses
/// for the same reason is listed together, and then the rows that miss the same. O(n log n).
std::vector<std::string> grouped(const std::vector<Missing>& missing);

}  // namespace loopbench

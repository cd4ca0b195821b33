/// Notes with the reasons for missing values in a table, grouped.
#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <vector>

namespace loopbench::harness {

/// One missing value, or all values of a row if `what` is empty.
struct Missing {
  std::string row;
  std::string what;    ///< "ate rotation"
  std::string status;  ///< "declined", "undefined"
  std::string why;
};

/// One line for each reason, in order of appearance: "ROWS: WHATS STATUS: WHY". Groups values of
/// one row with the same reason, then rows with the same groups. O(n log n).
std::vector<std::string> grouped(const std::vector<Missing>& missing);

/// Note that the closures of these sequences are oracle, with at most `most` names; empty without
/// sequences.
std::string oracle_closures_note(const std::set<std::string>& sequences, std::size_t most);

}  // namespace loopbench::harness

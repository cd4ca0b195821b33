/// Completes the layout of a table so that each cell has one score.
#pragma once

#include <string>
#include <vector>

#include "harness/model/record.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench::harness {

/// Layouts such as `--split ''` or `--rows sequence` leave open which times and scores a cell
/// contains. Keeps dense times (without any: the first) if the layout does not separate times;
/// makes methods the columns if the layout does not contain them, and then keeps the first shown
/// score. Empty names in the layout are removed. Returns a note about what is shown; empty if
/// nothing was selected. O(n).
std::string make_usual(std::vector<Record>& records, TableSpec& spec);

}  // namespace loopbench::harness

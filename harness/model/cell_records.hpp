/// Rows of the long table from the result of a cell.
#pragma once

#include <vector>

#include "harness/model/record.hpp"
#include "harness/model/result.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench::harness {

/// One record for each score of a cell of the sweep, or one without a metric if it has none.
std::vector<Record> records_of(const CellResult& result, const Sweep& sweep);

}  // namespace loopbench::harness

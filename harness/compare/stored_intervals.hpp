/// Intervals along the runs, from the traces of a store.
#pragma once

#include <filesystem>
#include <vector>

#include "harness/compare/compare.hpp"

namespace loopbench {

/// `add_intervals_along_runs` for comparisons under the first protocol of `records` (all of the
/// store, in its order), which is what traces are kept of. Throws InputError when `store` is none.
void add_intervals_from_traces(std::vector<Comparison>& comparisons,
                               const std::vector<Record>& records,
                               const std::filesystem::path& store);

}  // namespace loopbench

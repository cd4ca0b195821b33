/// Estimated durations of cells, for dividing a sweep into shards.
#pragma once

#include <filesystem>

#include "harness/catalogue/catalogue.hpp"
#include "harness/model/sweep.hpp"
#include "harness/shards/shard.hpp"

namespace loopbench::harness {

/// From the names of the methods and the sizes of the sequences, which are the `keyframes` option
/// or the size of the input files. Equal on all machines that find the same files. O(cells).
CellCosts estimated_costs(const Sweep& sweep,
                          const std::vector<Cell>& cells,
                          const Catalogue& catalogue,
                          const DataRoot& root);

/// From the times in an earlier store of the sweep, by labels: the mean over the repeats of a
/// sequence and method, or else the method's mean, or else the mean of all cells. Throws
/// InputError.
CellCosts measured_costs(const Sweep& sweep,
                         const std::vector<Cell>& cells,
                         const std::filesystem::path& store);

}  // namespace loopbench::harness

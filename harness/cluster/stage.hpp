/// Copies of input files on the disk of a node.
#pragma once

#include <filesystem>
#include <vector>

#include "harness/catalogue/catalogue.hpp"
#include "harness/model/cells.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench::harness {

/// Copies the files and folders that options of the cells' datasets name by relative paths into
/// `folder`, unless copies of the same size and date are there, and returns `root` with the copies
/// before the originals. Processes of one node wait for each other, so each file is copied once. If
/// the disk is full, a message is printed and the originals are used. O(bytes).
DataRoot stage_inputs(const Sweep& sweep,
                      const std::vector<Cell>& cells,
                      const Catalogue& catalogue,
                      const DataRoot& root,
                      const std::filesystem::path& folder);

}  // namespace loopbench::harness

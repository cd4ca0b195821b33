/// Cells that have changed since they were written.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/store/cell_rows.hpp"

namespace loopbench::harness {

/// All cells, checked with their scores and reports; with `traces` (nearly all of the file), these,
/// too. O(rows).
std::vector<StoredCell> checked_cells(Database& database, bool traces);

/// Removes every cell that is not intact, so that it counts as not run, and returns their labels;
/// `cells` keeps the others. Call within a transaction. O(cells).
std::vector<std::string> remove_damaged(Database& database, std::vector<StoredCell>& cells);

/// Throws InputError unless all cells, including their traces, are intact. O(bytes).
void require_intact_store(const std::filesystem::path& file);

}  // namespace loopbench::harness

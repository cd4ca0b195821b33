/// Removal of damaged rows from a store.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/store/cell_rows.hpp"
#include "harness/store/sequence_rows.hpp"

namespace loopbench::harness {

struct CheckedStore {
  CellRows cells;
  SequenceRows sequences;
  std::vector<std::string> removed;  ///< labels of the damaged cells
  bool lost = false;                 ///< further cells are missing completely
};

/// Compares all rows with their digests; the traces (nearly all of the file) only with `traces`.
/// O(rows).
CheckedStore check_rows(Database& database, bool traces);

/// Removes every cell that is damaged, or whose sequence is; it counts as not run. Checks traces
/// (nearly all of the file) and indexes only with `traces`. Call within a transaction. O(rows).
/// Throws InputError if the damage is outside the cells.
CheckedStore remove_damaged(Database& database, const std::filesystem::path& file, bool traces);

/// Removes the rows of cells and sequences that have no row of their own. O(rows).
void remove_orphans(Database& database);

/// Throws InputError unless the complete store, including traces, is as written. O(bytes).
void require_intact_store(const std::filesystem::path& file);

/// Throws InputError unless `table`, run or provenance, is as written.
void require_intact_texts(Database& database,
                          const std::string& table,
                          const std::filesystem::path& file);

}  // namespace loopbench::harness

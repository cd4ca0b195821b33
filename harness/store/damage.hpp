/// Taking out of a store what is not as it was written.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/store/cell_rows.hpp"
#include "harness/store/sequence_rows.hpp"

namespace loopbench {

struct Sound {
  CellRows cells;
  SequenceRows sequences;
  std::vector<std::string> removed;  ///< labels of the cells that were damaged
  bool lost = false;                 ///< others, of which nothing is left
};

/// Removes every cell that is damaged, or whose sequence is: it counts as never run. Traces, nearly
/// all of the file, and indexes are seen to only with `traces`. To be called within a transaction.
/// O(rows). Throws InputError when what is damaged is not of a cell.
Sound remove_damaged(Database& database, const std::filesystem::path& file, bool traces);

/// Throws InputError unless all of the store is what was written, traces too. O(bytes).
void require_whole_store(const std::filesystem::path& file);

/// Throws InputError unless `table`, run or provenance, is what was written.
void require_whole_texts(Database& database,
                         const std::string& table,
                         const std::filesystem::path& file);

}  // namespace loopbench

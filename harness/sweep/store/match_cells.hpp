/// Matches the cells of a store with those of a sweep.
#pragma once

#include "harness/sweep/run/cell_keys.hpp"
#include "harness/sweep/store/store.hpp"
#include "harness/sweep/store/stored_cells.hpp"

namespace loopbench::harness {

/// The part of Store::resume() (store.cpp) that decides which cells are there and moves them to
/// their positions. `stored`: intact cells of the store. Call within a transaction.
Resumed match_cells(Database& database,
                    const std::vector<StoredCell>& stored,
                    CellKeys& keys,
                    const std::vector<Cell>& all,
                    const std::vector<Cell>& planned,
                    Retry retry);

/// The planned cells without an intact result in a store, which is not changed. Throws InputError
/// if it is not a store. O(bytes of the store and input).
std::vector<Cell> missing_cells(const std::filesystem::path& store,
                                CellKeys& keys,
                                const std::vector<Cell>& all,
                                const std::vector<Cell>& planned);

}  // namespace loopbench::harness

#pragma once

#include <cstddef>
#include <vector>

#include "harness/store/cell_rows.hpp"
#include "harness/store/sequence_rows.hpp"
#include "harness/store/sqlite.hpp"

namespace loopbench::harness {

/// In a store of evaluated files, replaces the content of every file by that of its run, see
/// recorded_content(). Other stores are not changed: there, the methods of a run share a sequence.
/// `order`: in_order(cells). O(cells).
void join_recorded_contents(Database& database,
                            const std::vector<StoredCell>& cells,
                            const std::vector<std::size_t>& order,
                            SequenceRows& sequences);

}  // namespace loopbench::harness

/// Hashes of the rows of cells, by which damage is found.
#pragma once

#include <cstdint>
#include <vector>

#include "harness/sweep/store/stored_cells.hpp"

namespace loopbench::harness {

/// Marks the cells whose rows do not have the stored hash. `hashes`: of what precedes the rows.
void check_rows(Database& database,
                std::vector<StoredCell>& cells,
                bool of_traces,
                const std::vector<std::uint64_t>& hashes);

/// Continues a hash with the rows of a cell, those of its trace or the others.
std::uint64_t with_rows(Database& database, std::uint64_t hash, std::int64_t id, bool of_trace);

}  // namespace loopbench::harness

/// Copies rows of an attached store, `source`, into the store of the connection, `main`.
#pragma once

#include <cstdint>

#include "harness/store/sqlite.hpp"

namespace loopbench::harness {

/// The sequences of the current config that `main` does not have, with inputs and traces.
void copy_sequences(Database& database);

/// Scores, reports and traces of the cells whose ids are in the table `copied`. `offset`: from the
/// ids of `source` to those of `main`. Definitions of scores get the numbers of `main`. O(rows).
void copy_details(Database& database, std::int64_t offset);

/// The table run, and provenance of the cells in `copied`. Different values of run are concatenated
/// as lines; the baseline is that of the first store, and stores with different plans have none.
void copy_texts(Database& database);

}  // namespace loopbench::harness

/// Matching what a store holds with what a sweep asks for.
#pragma once

#include "harness/provenance/cell_keys.hpp"
#include "harness/store/sqlite.hpp"
#include "harness/store/store.hpp"

namespace loopbench {

/// See Store::resume. To be called within a transaction.
Resumed match(Database& database,
              CellKeys& keys,
              const std::vector<Cell>& all,
              const std::vector<Cell>& planned,
              Retry retry);

}  // namespace loopbench

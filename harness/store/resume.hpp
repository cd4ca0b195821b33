/// Matching what a store holds with what a sweep asks for.
#pragma once

#include "harness/provenance/cell_keys.hpp"
#include "harness/store/damage.hpp"
#include "harness/store/sqlite.hpp"
#include "harness/store/store.hpp"

namespace loopbench {

/// See Store::resume. `there`: what the store holds. To be called within a transaction.
Resumed match(Database& database,
              const Sound& there,
              CellKeys& keys,
              const std::vector<Cell>& all,
              const std::vector<Cell>& planned,
              Retry retry);

}  // namespace loopbench

/// Options of sequences and methods as data, in key `options` of a store's table run.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "harness/sweep/run/cell_keys.hpp"
#include "harness/sweep/store/sqlite.hpp"
#include "harness/sweep/store/stored_cells.hpp"

namespace loopbench::harness {

/// JSON {datasets {LABEL: [[NAME, {OPTION: value}]]}, methods likewise}: of datasets the options of
/// the config, of methods those of all stages with their defaults.
std::string options_json(const CellKeys& keys);

/// Sets `dataset` and `stages` of the cells by their labels, as the config of the last run has
/// them. Not of cells without an entry.
void add_options(Database& database, std::vector<StoredCell>& cells);

}  // namespace loopbench::harness

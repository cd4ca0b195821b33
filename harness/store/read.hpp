/// Reads a store. Only cells of the current config are read; others are kept in the store for
/// reuse.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "harness/model/record.hpp"

namespace loopbench::harness {

/// All records in sweep order. A metric that failed or was declined completely has a record for
/// every score that it has elsewhere. `file` can be the folder with results.sqlite. Throws
/// InputError if it is not a store.
std::vector<Record> read_records(const std::filesystem::path& file);

/// One row per cell, in sweep order.
std::vector<CellRecord> read_cells(const std::filesystem::path& file);

/// The `run` table: config text, protocol, baseline, version.
std::map<std::string, std::string> read_run(const std::filesystem::path& file);

}  // namespace loopbench::harness

/// Reads a store. Only cells of the current config are read; others are kept in the store for
/// reuse. `file` can be the folder with results.sqlite. All functions throw InputError if it is not
/// a store, or if what they read is damaged.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "harness/model/record.hpp"
#include "harness/model/sequence_metadata.hpp"

namespace loopbench::harness {

/// All records in sweep order. A metric that failed or was declined completely has a record for
/// every score that it has elsewhere.
std::vector<Record> read_records(const std::filesystem::path& file);

/// One row per cell, in sweep order.
std::vector<CellRow> read_cells(const std::filesystem::path& file);

/// The `run` table: config text, protocol, baseline, version.
std::map<std::string, std::string> read_run(const std::filesystem::path& file);

/// Commit, compiler, machine and so on. Values that differ between cells are separate lines, in
/// sweep order.
std::map<std::string, std::string> read_provenance(const std::filesystem::path& file);

/// Input files of each sequence, by "LABEL" or "LABEL (repeat N)".
std::map<std::string, std::vector<InputFile>> read_inputs(const std::filesystem::path& file);

/// "DATASET: all options including defaults" of each loaded sequence, by the same labels.
std::map<std::string, std::string> read_dataset_options(const std::filesystem::path& file);

}  // namespace loopbench::harness

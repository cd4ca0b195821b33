/// Reading a store. Only what the config asks for is read: cells it asks for no more are kept for
/// their keys, but are in no answer here.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "harness/model/record.hpp"
#include "harness/model/sequence_facts.hpp"

namespace loopbench {

/// All records in the order of the sweep, whatever the order they were written in. A metric that
/// failed or was declined as a whole has a record for every score it gives elsewhere. `file` may be
/// the folder that holds results.sqlite. Throws InputError when it is not a store.
std::vector<Record> read_records(const std::filesystem::path& file);

/// One row per cell, in the order of the sweep.
std::vector<CellRecord> read_cells(const std::filesystem::path& file);

/// The `run` table: config text, protocol, baseline, version.
std::map<std::string, std::string> read_run(const std::filesystem::path& file);

/// By what the cells that the config asks for were made: commit, compiler, machine and so on. What
/// differs between cells stands on lines of its own, in the order of the sweep.
std::map<std::string, std::string> read_provenance(const std::filesystem::path& file);

/// The files each sequence was read from, by "LABEL" or "LABEL (repeat N)".
std::map<std::string, std::vector<InputFile>> read_inputs(const std::filesystem::path& file);

/// "DATASET: every option, defaults included" of each sequence that was loaded, by the same labels.
std::map<std::string, std::string> read_dataset_options(const std::filesystem::path& file);

}  // namespace loopbench

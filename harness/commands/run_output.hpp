/// Output of `loopbench run`: table files, the summary, and the commands to continue with.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/model/record.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench::harness {

/// Writes rows.csv, table.md, table.csv and provenance.json into the folder `out` of the store.
/// Throws InputError.
void write_tables(const std::filesystem::path& store,
                  const Sweep& sweep,
                  const std::vector<Record>& all,
                  const std::filesystem::path& out);

/// The summary, as fits the terminal or as Markdown. Without any score, the reasons.
std::string summary_text(std::vector<Record> records, const Sweep& sweep);

/// The command that merges the stores of all shards in the folder `out`.
std::string merge_command(const std::filesystem::path& out);

/// Commands that continue from the results in the folder `out`.
std::string next_commands(const std::filesystem::path& out);

}  // namespace loopbench::harness

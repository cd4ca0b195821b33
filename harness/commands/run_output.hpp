/// Output of `loopbench run`: the plan, messages, table files, the summary, and the commands to
/// continue with.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/model/cells.hpp"
#include "harness/model/record.hpp"
#include "harness/model/sweep.hpp"
#include "harness/store/store.hpp"

namespace loopbench::harness {

/// Prints the list of cells.
void print_plan(const Sweep& sweep, const std::vector<Cell>& planned);

/// Prints the reasons why sequences cannot be loaded to standard error; returns the exit code.
int report_bad_inputs(const std::vector<std::string>& reasons);

/// Prints to standard error which damaged cells are recomputed, if any.
void report_damage(const Resumed& resumed, const std::filesystem::path& store);

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

/// Output of `loopbench run`: the plan, messages, table files, the summary, and the commands to
/// continue with.
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "harness/commands/output_files.hpp"
#include "harness/sweep/catalogue/catalogue.hpp"
#include "harness/sweep/model/cells.hpp"
#include "harness/sweep/model/record.hpp"
#include "harness/sweep/model/sweep.hpp"
#include "harness/sweep/store/store.hpp"

namespace loopbench::harness {

/// Progress line with cells, rate and remaining time; only if standard error is a terminal.
class Progress {
 public:
  /// Prints nothing unless stderr is a terminal.
  explicit Progress(std::size_t total);
  ~Progress();  ///< clears the line
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Counts a finished cell; redraws at most ten times a second.
  void step(const std::string& label);

 private:
  using Clock = std::chrono::steady_clock;

  bool visible_;
  std::size_t total_;
  std::size_t done_ = 0;
  Clock::time_point begin_ = Clock::now();
  Clock::time_point drawn_{};
};

/// Throws MissingPart when a sequence of the cells needs a part that this build was made without.
void require_parts(const Sweep& sweep, const std::vector<Cell>& cells, const Catalogue& catalogue);

/// Prints the list of cells, and to standard error which of their sequences cannot be loaded, and
/// why; returns the exit code. Throws MissingPart if this build cannot read a file.
int dry_run(const Sweep& sweep,
            const std::vector<Cell>& cells,
            const Catalogue& catalogue,
            const DataRoot& root);

struct CellCounts {
  std::size_t earlier = 0;  ///< done in earlier runs
  std::size_t done = 0;     ///< all of them
  std::size_t failed = 0;
  std::size_t incomplete = 0;
  std::size_t abandoned = 0;
};

/// "12 of 12 cells done (3 of them in earlier runs), 0 failed; value: rmse; protocol: ...".
std::string status_text(const CellCounts& counts, std::size_t planned, const Sweep& sweep);

/// Prints to standard error which damaged cells are recomputed, if any.
void report_damage(const Resumed& resumed, const std::filesystem::path& store);

/// The files that write_tables() writes into the folder `out`.
std::vector<OutputFile> table_files(const std::filesystem::path& out);

/// Writes rows.csv, table.md, table.csv and provenance.json into the folder `out` of the store.
/// Throws InputError.
void write_tables(const std::filesystem::path& store,
                  const Sweep& sweep,
                  const std::vector<Record>& all,
                  const std::filesystem::path& out);

/// The summary, as fits the terminal or as Markdown. Without any score, the reasons.
std::string summary_text(const std::filesystem::path& store,
                         std::vector<Record> records,
                         const Sweep& sweep);

/// The command that merges the stores of all shards in the folder `out`.
std::string merge_command(const std::filesystem::path& out);

/// Commands that continue from the results in the folder `out`.
std::string next_commands(const std::filesystem::path& out);

}  // namespace loopbench::harness

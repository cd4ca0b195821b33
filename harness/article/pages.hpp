/// Everything that `reproduce` writes: tables, ledger, figures, and a page for each other config.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/article/paper_run.hpp"

namespace loopbench::harness {

struct PaperConfig {
  Sweep sweep;
  std::vector<PaperCell> cells;
};

/// Configs with baseline ORB_SLAM2 and rows N or M are pooled into tables.md, ledger.md and the
/// figures of the readings `text` and `guarded`. Every other config becomes a page of its
/// name without "paper_tables_", with the config's description: heat maps if all methods differ in
/// speed_band and turn_max, a matrix of gains if its table has sequences as rows, otherwise a table
/// per dataset. Returns the files. Throws InputError if a file cannot be written.
std::vector<std::filesystem::path> write_pages(const std::vector<PaperConfig>& configs,
                                               const std::filesystem::path& folder);

/// Whether `dense` of this cell is used by write_pages(); the rest can be freed.
bool needs_dense(const PaperCell& cell);

}  // namespace loopbench::harness

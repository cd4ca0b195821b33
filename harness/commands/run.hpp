/// Runs the sweep of a config, for commands that need its results.
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "harness/run/collect_provenance.hpp"

namespace loopbench::harness {

struct RunArguments {
  std::string config;
  std::string only;
  std::string data;
  std::string out;
  std::vector<std::filesystem::path> plugins;
  int jobs = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  std::string shard;  ///< "3/8"; empty: all cells
  bool dry_run = false;
  std::string retry = "none";
  bool fresh = false;
  bool failed_cells_ok = false;
  bool no_sandbox = false;
  bool save_trajectories = false;
  bool pin_instructions = false;
  bool quiet = false;  ///< writes the store only: no tables, no summary
};

/// Returns the exit code of `loopbench run`. Throws InputError, MissingPart.
int run_config(const RunArguments& arguments, const Source& source);

}  // namespace loopbench::harness

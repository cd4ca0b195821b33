/// What `run` computes, where it is kept, and what it hides from programs.
#pragma once

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "datasets/dataset.hpp"
#include "harness/sweep/catalogue/catalogue.hpp"
#include "harness/sweep/model/cells.hpp"
#include "harness/sweep/model/sweep.hpp"
#include "harness/sweep/process/sandbox.hpp"
#include "harness/sweep/store/shard.hpp"

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
};

/// Larger sweeps get no tables and no summary after each run, because they take longer than
/// matching the store with its config and all records do not fit into memory; `table` and `export`
/// read them a few sequences at a time.
inline constexpr std::size_t kMostCellsInTables = 100'000;

/// What to run, and where the results go.
struct RunPlan {
  Catalogue known;
  Sweep sweep;
  DataRoot root;
  std::vector<Cell> all;
  std::vector<Cell> selected;  ///< of --only
  std::vector<Cell> planned;   ///< of those, the shard's
  std::optional<Shard> shard;
  std::filesystem::path given;  ///< folder of the sweep's results
  std::filesystem::path out;    ///< folder of the store

  std::filesystem::path store() const { return out / "results.sqlite"; }
  bool has_tables() const { return all.size() <= kMostCellsInTables; }
};

/// Throws InputError.
RunPlan plan(const RunArguments& arguments);

/// Hides the data of all sequences, also of those that are not loaded yet, and all stores in reach.
SandboxOptions sandbox_of_sweep(const RunPlan& plan, const RunArguments& arguments);

}  // namespace loopbench::harness

/// Datasets that run programs.
#pragma once

#include <filesystem>
#include <vector>

#include "datasets/dataset.hpp"
#include "harness/execution/sandbox/sandbox.hpp"

namespace loopbench::harness {

inline constexpr const char* kCommandDataset = "command";

/// Sets the restrictions of programs that datasets run, for this process and its workers; default:
/// enabled. A program cannot reach the sequence's reference either, and writes in its own folder
/// only.
void set_dataset_sandbox(const SandboxOptions& sandbox);

/// Sets the folder for outputs of programs if there is no cache, for this process and its workers;
/// default: loopbench-programs in TMPDIR.
void set_uncached_programs(const std::filesystem::path& folder);

/// All of them. Outputs of programs are kept in `cache`; empty: see set_uncached_programs().
std::vector<DatasetEntry> external_datasets(const std::filesystem::path& cache);

}  // namespace loopbench::harness

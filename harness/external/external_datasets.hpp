/// Datasets that run programs.
#pragma once

#include <filesystem>
#include <vector>

#include "datasets/dataset.hpp"

namespace loopbench::harness {

inline constexpr const char* kCommandDataset = "command";

/// Sets the folder for outputs of programs if there is no cache, for this process and its workers;
/// default: loopbench-programs in TMPDIR.
void set_uncached_programs(const std::filesystem::path& folder);

/// All of them. Outputs of programs are kept in `cache`; empty: see set_uncached_programs().
std::vector<DatasetEntry> external_datasets(const std::filesystem::path& cache);

}  // namespace loopbench::harness

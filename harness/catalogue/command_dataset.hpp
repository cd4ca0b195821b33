/// The dataset `command`: any program as a SLAM system.
///
/// The program reads {sequence} and writes {trajectory}, the estimate without loop closing, as TUM;
/// and if it has them, next to it, {trajectory}.frames (all tracked poses), {trajectory}.loops
/// (closures, derive/closure_file.hpp) and {trajectory}.closed (its own estimate with loop
/// closing).
#pragma once

#include <filesystem>

#include "datasets/dataset.hpp"

namespace loopbench::harness {

inline constexpr const char* kCommandDataset = "command";

/// Sets the folder for outputs of programs if there is no cache, for this process and its workers;
/// default: loopbench-programs in TMPDIR.
void set_uncached_programs(const std::filesystem::path& folder);

/// Its entry. Outputs of programs are kept in `cache`; empty: see set_uncached_programs().
DatasetEntry command_dataset(const std::filesystem::path& cache);

}  // namespace loopbench::harness

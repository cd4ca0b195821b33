/// Datasets that run programs.
#pragma once

#include <filesystem>
#include <vector>

#include "datasets/dataset.hpp"

namespace loopbench::harness {

/// All of them. Outputs of programs are kept in `cache`; empty: in a temporary folder.
std::vector<DatasetEntry> external_datasets(const std::filesystem::path& cache);

}  // namespace loopbench::harness

/// Synthetic records through a store, as a sweep writes and `compare` reads them.
#pragma once

#include <filesystem>
#include <vector>

#include "harness/sweep/model/record.hpp"

namespace loopbench::synthetic {

using namespace harness;

/// Writes a new results.sqlite into the folder, with a cell for every record: its sequence, method,
/// group, content, status and RMSE. The baseline is m0.
void write_store(const std::vector<Record>& records, const std::filesystem::path& folder);

}  // namespace loopbench::synthetic

/// Computes the tables of a spec from a store, including gain and time.
#pragma once

#include <filesystem>
#include <vector>

#include "harness/tables/pivot.hpp"

namespace loopbench {

/// Stored records, then gains, pair counts and run times: columns in this order.
std::vector<Record> all_records(const std::filesystem::path& store);

}  // namespace loopbench

/// From a store to the tables of a spec, gain and time included.
#pragma once

#include <filesystem>
#include <vector>

#include "harness/tables/pivot.hpp"

namespace loopbench {

/// Stored records, then gains, pair counts and run times: columns in that order.
std::vector<Record> all_records(const std::filesystem::path& store);

}  // namespace loopbench

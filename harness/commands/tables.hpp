/// From a store to the records of tables, gain and time included, and to comparisons.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/compare/compare.hpp"
#include "harness/export/pivot.hpp"

namespace loopbench {

/// Stored records, then gains, pair counts and run times: columns in that order.
std::vector<Record> all_records(const std::filesystem::path& store);

/// What `loopbench compare` prints: comparisons of one metric, by its label, the short name of a
/// score ("error x") or its name, over the records that the rules keep (export/where.hpp). An empty
/// baseline stands for the sweep's. Throws InputError where no score or no baseline is left.
std::vector<Comparison> compare_store(const std::filesystem::path& store,
                                      const std::string& metric,
                                      const std::vector<std::string>& rules,
                                      CompareOptions options);

}  // namespace loopbench

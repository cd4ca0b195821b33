/// Reads the records of tables from a store, including gains, pair counts and run times.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "harness/compare/compare.hpp"

namespace loopbench::harness {

/// Visits the records sequence by sequence: those that are stored, then the derived ones.
void for_each_record(const std::filesystem::path& store,
                     const std::function<void(const Record&)>& visit);

/// All of for_each_record().
std::vector<Record> all_records(const std::filesystem::path& store);

/// The comparisons that `loopbench compare` prints, for one metric selected by its label, the short
/// name of a score ("error x") or its name, over the records that pass the filters `rules` (see
/// model/where.hpp). An empty baseline selects the sweep's. Throws InputError if no score or no
/// baseline remains.
std::vector<Comparison> compare_store(const std::filesystem::path& store,
                                      const std::string& metric,
                                      const std::vector<std::string>& rules,
                                      CompareOptions options);

}  // namespace loopbench::harness

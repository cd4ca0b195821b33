/// Reads the records of tables from a store, including gain and time, and compares methods.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "harness/compare/compare.hpp"
#include "harness/store/record_reader.hpp"
#include "harness/tables/pivot.hpp"

namespace loopbench::harness {

/// Stored records, then gains, pair counts and run times: columns in this order.
std::vector<Record> all_records(const std::filesystem::path& store);

/// Visits the stored records and, if `derived`, the same records as all_records(), in that order,
/// until `visit` returns false. Reads the store up to four times, with little memory.
void for_each_record(RecordReader& reader,
                     const std::string& baseline,
                     bool derived,
                     const std::function<bool(const Record&)>& visit);

/// The comparisons that `loopbench compare` prints, for one metric selected by its label, the short
/// name of a score ("error x") or its name, over the records that pass the filters `rules` (see
/// model/where.hpp). An empty baseline selects the sweep's. Throws InputError if no score or no
/// baseline remains.
std::vector<Comparison> compare_store(const std::filesystem::path& store,
                                      const std::string& metric,
                                      const std::vector<std::string>& rules,
                                      CompareOptions options);

}  // namespace loopbench::harness

/// The records of a store as commands print them: with gains, pair counts and run times, in tables
/// and in comparisons.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "harness/answers/compare/compare.hpp"
#include "harness/answers/tables/pivot.hpp"
#include "harness/sweep/model/record.hpp"

namespace loopbench::harness {

/// Visits the records sequence by sequence: those that are stored, then the derived ones, of costs
/// those that are `asked` for (see cost_scores()).
void for_each_record(const std::filesystem::path& store,
                     const std::function<void(const Record&)>& visit,
                     const std::vector<std::string>& asked = {});

/// All of for_each_record().
std::vector<Record> all_records(const std::filesystem::path& store,
                                const std::vector<std::string>& asked = {});

/// The texts by which a table can ask for costs: the scores that it shows, and the filters.
inline std::vector<std::string> asked_by(const TableSpec& spec,
                                         const std::vector<std::string>& rules) {
  std::vector<std::string> out = spec.show;
  out.insert(out.end(), rules.begin(), rules.end());
  return out;
}

/// The comparisons that `loopbench compare` prints, for one metric selected by its label, the short
/// name of a score ("error x") or its name, over the records that pass the filters `rules` (see
/// model/where.hpp). An empty baseline selects the sweep's. Throws InputError if no score or no
/// baseline remains.
std::vector<Comparison> compare_store(const std::filesystem::path& store,
                                      const std::string& metric,
                                      const std::vector<std::string>& rules,
                                      CompareOptions options);

/// The tables that `loopbench table` prints: pivot() of all_records() that pass the filters `rules`
/// (see model/where.hpp). A layout that leaves open which times and scores a cell contains, such as
/// `--split ''` or `--rows sequence`, is completed: dense times, methods as columns, the first
/// score; a note reports it. Empty names in the layout are ignored. The memory does not grow with
/// the number of sequences if the layout splits by sequence and separates methods and times, as by
/// default. Throws InputError if no record passes.
std::vector<Table> store_tables(const std::filesystem::path& store,
                                const std::vector<std::string>& rules,
                                TableSpec spec);

}  // namespace loopbench::harness

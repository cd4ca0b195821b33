/// Tables of a store, read a few sequences at a time.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/tables/pivot.hpp"

namespace loopbench::harness {

/// The tables that `loopbench table` prints: pivot() of all_records() that pass the filters `rules`
/// (see model/where.hpp). A layout that leaves open which times and scores a cell contains, such as
/// `--split ''` or `--rows sequence`, is completed: dense times, methods as columns, the first
/// score; a note reports it. Empty names in the layout are ignored. The memory does not grow with
/// the number of sequences if the layout splits by sequence and separates methods and times, as by
/// default. Throws InputError if no record passes.
std::vector<Table> store_tables(const std::filesystem::path& store,
                                const std::vector<std::string>& rules,
                                TableSpec spec,
                                const RankingOptions& options);

}  // namespace loopbench::harness

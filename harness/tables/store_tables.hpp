/// Tables of a store, read a few sequences at a time.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/tables/pivot.hpp"

namespace loopbench::harness {

/// The tables that `loopbench table` prints: pivot() of all_records() that pass the filters `rules`
/// (see model/where.hpp), with a layout completed as in usual_table.hpp. The memory does not grow
/// with the number of sequences if the layout splits by sequence and separates methods and times,
/// as by default. Throws InputError if no record passes.
std::vector<Table> store_tables(const std::filesystem::path& store,
                                const std::vector<std::string>& rules,
                                TableSpec spec,
                                const RankingOptions& options);

}  // namespace loopbench::harness

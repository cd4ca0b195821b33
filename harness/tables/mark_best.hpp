/// Marks of the best values in a table.
#pragma once

#include "harness/compare/ranking.hpp"
#include "harness/model/sweep.hpp"
#include "harness/tables/table.hpp"
#include "harness/tables/table_numbers.hpp"

namespace loopbench::harness {

/// Marks the methods that `compare` calls best (with any baseline) among the records of each column
/// (or row) of the finished table `out`, and adds a note about it or the reason why none is marked.
/// A column with several scores, or with several entries of a method, has no marks.
void mark_best(Table& out,
               const TableNumbers& table,
               const TableSpec& spec,
               bool along_columns,
               const CompareOptions& options);

}  // namespace loopbench::harness

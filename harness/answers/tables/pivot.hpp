/// Conversion of a long table to rows x columns, one table per combination of the split columns.
#pragma once

#include <initializer_list>
#include <vector>

#include "harness/answers/tables/table.hpp"
#include "harness/sweep/model/record.hpp"
#include "harness/sweep/model/sweep.hpp"

namespace loopbench::harness {

inline constexpr const char* kEmptyTable = "the table is empty: no rows to show";

/// Each cell has the mean of its records. The title has the values of the split columns, the notes
/// the reasons for missing values. If the rows are methods, marks the best of each column (see
/// table_numbers.hpp); if the columns are methods, the best of each row. Entries with fewer runs
/// than others state their number; means are then over common runs (table_numbers.hpp), and a note
/// reports it. Gains are averaged as geometric means of the ratios. Several protocols always result
/// in separate tables. Rows, columns and tables are in order of first appearance in the records.
/// Throws InputError for an unknown column or statistic, and if an entry would average different
/// scores (rotation with translation, keyframes with dense). O(n log n).
std::vector<Table> pivot(const std::vector<Record>& records, const TableSpec& spec);

/// The tables of some of the records, for records that are not in memory at once: of complete
/// sequences, if `spec` splits by sequence; those without scores last. Several protocols must be
/// separated by `spec`. Does not throw if there is none.
std::vector<Table> pivot_parts(const std::vector<Record>& records, const TableSpec& spec);

/// Whether the layout is by options of methods, without the methods themselves.
bool is_by_option(const TableSpec& spec);

/// Whether rows, columns or split contain one of the fields.
bool separates(const TableSpec& spec, std::initializer_list<const char*> any_of);

}  // namespace loopbench::harness

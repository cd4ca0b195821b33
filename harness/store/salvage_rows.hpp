/// First step of salvage: writes all rows of a damaged store that can be decoded into a new one.
#pragma once

#include "harness/store/page_file.hpp"
#include "harness/store/sqlite.hpp"

namespace loopbench::harness {

/// Inserts every row of `view` that fits a table of the store's schema into that table of
/// `database`, with its rowid. The rows are not checked against their digests. O(bytes).
void insert_rows(Database& database, const PageFile& file, const PageView& view);

}  // namespace loopbench::harness

/// SQLite files of other programs, opened for reading only.
#pragma once

#include <sqlite3.h>

#include <initializer_list>
#include <memory>
#include <string_view>

#include "datasets/compressed/input_file.hpp"

namespace loopbench {

struct CloseSqlite {
  void operator()(sqlite3* handle) const { sqlite3_close(handle); }
  void operator()(sqlite3_stmt* handle) const { sqlite3_finalize(handle); }
};
using SqliteFile = std::unique_ptr<sqlite3, CloseSqlite>;
using SqliteQuery = std::unique_ptr<sqlite3_stmt, CloseSqlite>;

/// Opens a file that nobody writes, or one in memory. Throws InputError.
SqliteFile open_sqlite(const OpenedFile& file);

/// Null if the file has no such tables or columns.
SqliteQuery prepared(const SqliteFile& db, const char* sql);

/// Whether the file has these tables. A view could compute anything, for any time, and is none.
bool has_tables(const SqliteFile& db, std::initializer_list<std::string_view> names);

/// Bytes of a column of the current row, valid until the next row.
std::string_view blob(const SqliteQuery& query, int column);

}  // namespace loopbench

/// SQLite files of other programs, opened for reading only.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>

#include "datasets/compressed/input_file.hpp"

struct sqlite3;
struct sqlite3_stmt;

namespace loopbench {

struct CloseSqlite {
  void operator()(sqlite3* handle) const;
  void operator()(sqlite3_stmt* handle) const;
};
using SqliteFile = std::unique_ptr<sqlite3, CloseSqlite>;
using SqliteQuery = std::unique_ptr<sqlite3_stmt, CloseSqlite>;

/// Opens a file that nobody writes, or one in memory. Throws InputError.
SqliteFile open_sqlite(const OpenedFile& file);

/// Null if the file has no such tables or columns.
SqliteQuery prepared(const SqliteFile& db, const char* sql);

/// Whether the file has these tables. A view could compute anything, for any time, and is none.
bool has_tables(const SqliteFile& db, std::initializer_list<std::string_view> names);

enum class SqliteStep { row, done, failed };

/// Moves to the next row; failed without a query.
SqliteStep step(const SqliteQuery& query);

/// Columns of the current row; texts and bytes are valid until the next row.
std::int64_t integer(const SqliteQuery& query, int column);
std::string_view text(const SqliteQuery& query, int column);
std::string_view blob(const SqliteQuery& query, int column);

/// Why the last step failed.
std::string last_error(const SqliteFile& db);

}  // namespace loopbench

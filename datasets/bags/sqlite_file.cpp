#include "datasets/bags/sqlite_file.hpp"

#include <fmt/format.h>
#include <sqlite3.h>

#include <algorithm>
#include <fstream>
#include <string>

namespace loopbench {
namespace {

/// URI of a file that nobody writes: no locks, no journal.
std::string uri_of(const std::string& path) {
  std::string out = "file:";
  for (const char c : path) {
    const bool is_special = c == '%' || c == '?' || c == '#';
    out += is_special ? fmt::format("%{:02X}", static_cast<unsigned char>(c)) : std::string(1, c);
  }
  return out + "?immutable=1";
}

/// Replaces the empty database of `db` by a file in memory, which has no path that SQLite can open:
/// it was decompressed, or read from a pipe.
int load_into(sqlite3* db, const OpenedFile& file) {
  auto* const bytes = static_cast<unsigned char*>(sqlite3_malloc64(file.size));
  if (bytes == nullptr) return SQLITE_NOMEM;
  std::ifstream in(file.path, std::ios::binary);
  if (!in.read(reinterpret_cast<char*>(bytes), static_cast<std::streamsize>(file.size))) {
    sqlite3_free(bytes);
    return SQLITE_IOERR_READ;
  }
  // SQLite rejects a database in memory that has a write-ahead log, which is a second file.
  constexpr std::size_t kWriteVersion = 18, kReadVersion = 19;
  if (file.size > kReadVersion) bytes[kWriteVersion] = bytes[kReadVersion] = 1;
  const auto size = static_cast<sqlite3_int64>(file.size);
  constexpr unsigned kFlags = SQLITE_DESERIALIZE_READONLY | SQLITE_DESERIALIZE_FREEONCLOSE;
  return sqlite3_deserialize(db, "main", bytes, size, size, kFlags);
}

}  // namespace

void CloseSqlite::operator()(sqlite3* handle) const { sqlite3_close(handle); }
void CloseSqlite::operator()(sqlite3_stmt* handle) const { sqlite3_finalize(handle); }

SqliteFile open_sqlite(const OpenedFile& file) {
  const bool in_memory = file.memory != nullptr;
  sqlite3* handle = nullptr;
  int code =
      sqlite3_open_v2(in_memory ? ":memory:" : uri_of(file.path).c_str(),
                      &handle,
                      SQLITE_OPEN_NOMUTEX | (in_memory ? SQLITE_OPEN_READWRITE
                                                       : SQLITE_OPEN_READONLY | SQLITE_OPEN_URI),
                      nullptr);
  SqliteFile out(handle);
  if (code == SQLITE_OK && in_memory) code = load_into(handle, file);
  if (code != SQLITE_OK) throw file.error(std::string("cannot be opened: ") + sqlite3_errstr(code));
  // Without this, SQLite rejects truncated files as a whole. The file is opened read-only.
  sqlite3_db_config(handle, SQLITE_DBCONFIG_WRITABLE_SCHEMA, 1, nullptr);
  sqlite3_db_config(handle, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  return out;
}

SqliteQuery prepared(const SqliteFile& db, const char* sql) {
  sqlite3_stmt* query = nullptr;
  if (sqlite3_prepare_v2(db.get(), sql, -1, &query, nullptr) != SQLITE_OK) return nullptr;
  return SqliteQuery(query);
}

bool has_tables(const SqliteFile& db, std::initializer_list<std::string_view> names) {
  const SqliteQuery query = prepared(db, "SELECT name FROM sqlite_master WHERE type = 'table'");
  std::size_t found = 0;
  while (step(query) == SqliteStep::row) found += std::ranges::count(names, text(query, 0)) > 0;
  return found == names.size();
}

SqliteStep step(const SqliteQuery& query) {
  const int code = query ? sqlite3_step(query.get()) : SQLITE_CORRUPT;
  if (code == SQLITE_ROW) return SqliteStep::row;
  return code == SQLITE_DONE ? SqliteStep::done : SqliteStep::failed;
}

std::int64_t integer(const SqliteQuery& query, int column) {
  return sqlite3_column_int64(query.get(), column);
}

std::string_view text(const SqliteQuery& query, int column) {
  const auto* found = reinterpret_cast<const char*>(sqlite3_column_text(query.get(), column));
  return found == nullptr ? std::string_view() : std::string_view(found);
}

std::string_view blob(const SqliteQuery& query, int column) {
  const auto* data = static_cast<const char*>(sqlite3_column_blob(query.get(), column));
  const int size = sqlite3_column_bytes(query.get(), column);
  return data == nullptr ? std::string_view()
                         : std::string_view(data, static_cast<std::size_t>(size));
}

std::string last_error(const SqliteFile& db) { return sqlite3_errmsg(db.get()); }

}  // namespace loopbench

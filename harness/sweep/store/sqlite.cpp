#include "harness/sweep/store/sqlite.hpp"

#include <sqlite3.h>

#include <exception>

#include "datasets/core/error.hpp"

namespace loopbench::harness {
namespace {

[[gnu::always_inline]] inline std::string_view bytes_of(sqlite3_value* value) {
  const auto* bytes = static_cast<const char*>(sqlite3_value_blob(value));
  const auto size = static_cast<std::size_t>(sqlite3_value_bytes(value));
  return bytes == nullptr ? std::string_view{} : std::string_view(bytes, size);
}

[[gnu::always_inline]] inline void add_value(RowHash& row, sqlite3_value* value) {
  switch (sqlite3_value_type(value)) {
    case SQLITE_INTEGER:
      return row.add(sqlite3_value_int64(value));
    case SQLITE_FLOAT:
      return row.add(sqlite3_value_double(value));
    case SQLITE_NULL:
      return row.add_null();
    default:
      return row.add(bytes_of(value));
  }
}

/// Hash of `value(i)` for the columns from `first` up to `end`.
template <class Value>
std::uint64_t hash_of_columns(std::uint64_t before, int first, int end, const Value& value) {
  thread_local RowHash row;  // keeps its memory
  row.clear();
  for (int i = first; i < end; ++i) add_value(row, value(i));
  return row.after(before);
}

/// Calls the function that a query passes to SQLite.
void visit_row(sqlite3_context* context, int count, sqlite3_value** values) {
  using Visit = std::function<void(const RowValues&)>;
  try {
    (*static_cast<const Visit*>(sqlite3_user_data(context)))({values, count});
  } catch (const std::exception& error) {  // may not pass through SQLite
    sqlite3_result_error(context, error.what(), -1);
  }
}

}  // namespace

void RowHash::grow(std::size_t count) { bytes_.resize(2 * (size_ + count)); }

std::int64_t RowValues::integer(int column) const { return sqlite3_value_int64(values[column]); }

std::uint64_t RowValues::hashed(std::uint64_t before, int first) const {
  return hash_of_columns(before, first, count, [&](int i) { return values[i]; });
}

Database::Database(const std::filesystem::path& file, Mode mode) : file_(file.string()) {
  sqlite3* handle = nullptr;
  // Used by one thread at a time; a WAL left by a killed process is merged on opening for writing.
  const int flags = SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_READWRITE |
                    (mode == Mode::create ? SQLITE_OPEN_CREATE : 0) |
                    (file_.starts_with(kMemoryPrefix) ? SQLITE_OPEN_URI : 0);
  int code = sqlite3_open_v2(file_.c_str(), &handle, flags, nullptr);
  if (code != SQLITE_OK && mode == Mode::read) {
    sqlite3_close(handle);
    code = sqlite3_open_v2(
        file_.c_str(), &handle, SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_READONLY, nullptr);
  }
  handle_.reset(handle);
  if (code != SQLITE_OK) fail("cannot be opened");
  sqlite3_busy_timeout(handle, 10000);  // [ms]
  // A store can come from anybody: its schema may not run functions or change internal tables.
  sqlite3_db_config(handle, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(handle, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_db_config(handle, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
}

void Database::execute(const std::string& sql) {
  if (sqlite3_exec(handle_.get(), sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) {
    fail("rejected a statement");
  }
}

std::int64_t Database::last_row() const { return sqlite3_last_insert_rowid(handle_.get()); }

Transaction::~Transaction() {
  if (!open_) return;
  try {
    database_.execute("ROLLBACK");
  } catch (const std::exception&) {
    // SQLite has already rolled back, as it does when the disk is full.
  }
}

Statement Database::prepare(const std::string& sql) {
  sqlite3_stmt* statement = nullptr;
  const int size = static_cast<int>(sql.size());
  if (sqlite3_prepare_v2(handle_.get(), sql.c_str(), size, &statement, nullptr) != SQLITE_OK) {
    fail("rejected a statement");
  }
  return {*this, statement};
}

std::int64_t Database::integer(const std::string& query) {
  Statement row = prepare(query);
  return row.step() ? row.integer() : 0;
}

std::string Database::columns_of(const std::string& table) {
  Statement row =
      prepare("SELECT group_concat(name, ', ') FROM pragma_table_info('" + table + "')");
  return row.step() ? row.text() : "";
}

void Database::for_each_row(const std::string& table,
                            std::int64_t first,
                            std::int64_t last,
                            const std::function<void(const RowValues&)>& visit) {
  const std::string columns = columns_of(table);
  void* const passed = const_cast<std::function<void(const RowValues&)>*>(&visit);
  const int code = sqlite3_create_function_v2(handle_.get(),
                                              "visit_row",
                                              -1,
                                              SQLITE_UTF8 | SQLITE_DIRECTONLY,
                                              passed,
                                              visit_row,
                                              nullptr,
                                              nullptr,
                                              nullptr);
  if (code != SQLITE_OK) fail("cannot be read");
  // The function returns NULL, so that no row is selected.
  prepare("SELECT 1 FROM " + table + " WHERE cell BETWEEN ? AND ? AND visit_row(" + columns + ")")
      .bind(first, last)
      .run();
}

void Database::fail(const std::string& doing) const {
  const bool damaged = sqlite3_errcode(handle_.get()) == SQLITE_CORRUPT;
  throw InputError(file_ + ": " + doing + ": " + sqlite3_errmsg(handle_.get()) +
                   (damaged ? std::string("; ") + kRecoverAdvice : ""));
}

void Statement::expect(int code, const char* doing) const {
  if (code != SQLITE_OK) database_->fail(doing);
}

void Statement::bind_integer(std::int64_t value) {
  expect(sqlite3_bind_int64(handle_.get(), ++parameter_, value), "cannot bind");
}

void Statement::bind_one(double value) {
  expect(sqlite3_bind_double(handle_.get(), ++parameter_, value), "cannot bind");
}

void Statement::bind_one(std::string_view value) {
  const int size = static_cast<int>(value.size());
  const char* data = value.data() == nullptr ? "" : value.data();  // null would bind NULL
  expect(sqlite3_bind_text(handle_.get(), ++parameter_, data, size, SQLITE_TRANSIENT),  // NOLINT
         "cannot bind");
}

void Statement::bind_one(Blob value) {
  const int size = static_cast<int>(value.bytes.size());
  const char* data = value.bytes.data() == nullptr ? "" : value.bytes.data();
  expect(sqlite3_bind_blob(handle_.get(), ++parameter_, data, size, SQLITE_STATIC), "cannot bind");
}

void Statement::bind_one(std::nullptr_t) {
  expect(sqlite3_bind_null(handle_.get(), ++parameter_), "cannot bind");
}

void Statement::run() {
  while (step()) {
  }
  expect(sqlite3_reset(handle_.get()), "cannot write");
  parameter_ = 0;
}

void Statement::reset() {
  sqlite3_reset(handle_.get());
  parameter_ = 0;
}

bool Statement::step() {
  column_ = 0;
  const int code = sqlite3_step(handle_.get());
  if (code != SQLITE_ROW && code != SQLITE_DONE) database_->fail("cannot be read or written");
  return code == SQLITE_ROW;
}

bool Statement::is_null() const {
  return sqlite3_column_type(handle_.get(), column_) == SQLITE_NULL;
}

void Statement::read_one(double& value) { value = sqlite3_column_double(handle_.get(), column_++); }

std::int64_t Statement::integer() { return sqlite3_column_int64(handle_.get(), column_++); }
std::string Statement::text() { return std::string(view()); }

std::string_view Statement::view() {
  return bytes_of(sqlite3_column_value(handle_.get(), column_++));
}

std::uint64_t Statement::hashed(std::uint64_t before, int first, int without) const {
  const int end = sqlite3_column_count(handle_.get()) - without;
  return hash_of_columns(
      before, first, end, [&](int i) { return sqlite3_column_value(handle_.get(), i); });
}

}  // namespace loopbench::harness

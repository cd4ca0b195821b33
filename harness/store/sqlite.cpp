#include "harness/store/sqlite.hpp"

#include <sqlite3.h>

#include <array>
#include <cstring>
#include <utility>

#include "datasets/core/error.hpp"

namespace loopbench::harness {

void Database::Close::operator()(sqlite3* handle) const { sqlite3_close(handle); }
void Statement::Finalize::operator()(sqlite3_stmt* handle) const { sqlite3_finalize(handle); }

Database::Database(const std::filesystem::path& file, Mode mode) : file_(file.string()) {
  sqlite3* handle = nullptr;
  // Used by one thread at a time; a WAL left by a killed process is merged on opening for writing.
  const int flags =
      SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_READWRITE | (mode == Mode::create ? SQLITE_OPEN_CREATE : 0);
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

void Database::fail(const std::string& doing) const {
  const bool damaged = sqlite3_errcode(handle_.get()) == SQLITE_CORRUPT;
  throw InputError(file_ + ": " + doing + ": " + sqlite3_errmsg(handle_.get()) +
                   (damaged ? std::string("; ") + kRecoverAdvice : ""));
}

void Statement::expect(int code, const char* doing) const {
  if (code != SQLITE_OK) database_->fail(doing);
}

Statement& Statement::bind(std::int64_t value) {
  expect(sqlite3_bind_int64(handle_.get(), ++parameter_, value), "cannot bind");
  return *this;
}

Statement& Statement::bind(double value) {
  expect(sqlite3_bind_double(handle_.get(), ++parameter_, value), "cannot bind");
  return *this;
}

Statement& Statement::bind(const std::string& value) {
  const int size = static_cast<int>(value.size());
  expect(sqlite3_bind_text(
             handle_.get(), ++parameter_, value.data(), size, SQLITE_TRANSIENT),  // NOLINT
         "cannot bind");
  return *this;
}

Statement& Statement::bind_blob(std::string_view bytes) {
  const int size = static_cast<int>(bytes.size());
  // A null pointer would bind NULL instead of an empty blob.
  const char* data = bytes.data() == nullptr ? "" : bytes.data();
  expect(sqlite3_bind_blob(handle_.get(), ++parameter_, data, size, SQLITE_STATIC), "cannot bind");
  return *this;
}

Statement& Statement::bind_null() {
  expect(sqlite3_bind_null(handle_.get(), ++parameter_), "cannot bind");
  return *this;
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

std::int64_t Statement::integer() { return sqlite3_column_int64(handle_.get(), column_++); }
double Statement::real() { return sqlite3_column_double(handle_.get(), column_++); }

std::optional<std::int64_t> Statement::maybe_integer() {
  const bool none = sqlite3_column_type(handle_.get(), column_) == SQLITE_NULL;
  const std::int64_t value = integer();
  return none ? std::nullopt : std::optional(value);
}

std::optional<double> Statement::maybe_real() {
  const bool none = sqlite3_column_type(handle_.get(), column_) == SQLITE_NULL;
  const double value = real();
  return none ? std::nullopt : std::optional(value);
}

int Statement::columns() const { return sqlite3_column_count(handle_.get()); }

std::string_view Statement::bytes_of_columns(int from, int to) {
  bytes_.clear();
  append_columns(from, to, bytes_);
  return bytes_;
}

void Statement::append_columns(int from, int to, std::string& bytes) {
  constexpr std::size_t kNumber = 1 + sizeof(std::int64_t);  // type and value
  std::array<char, 32 * kNumber> block;  // one append for many columns: a store has 10^8 of them
  std::size_t size = 0;
  const auto flush = [&] { bytes.append(block.data(), std::exchange(size, 0)); };
  const auto add = [&](const auto& value) {
    std::memcpy(block.data() + size, &value, sizeof value);
    size += sizeof value;
  };
  for (int i = from; i < to; ++i) {
    if (size + kNumber > block.size()) flush();
    sqlite3_value* const column = sqlite3_column_value(handle_.get(), i);
    const int type = sqlite3_value_type(column);
    add(static_cast<char>(type));
    if (type == SQLITE_INTEGER) {
      add(std::int64_t{sqlite3_value_int64(column)});
    } else if (type == SQLITE_FLOAT) {
      add(sqlite3_value_double(column));
    } else if (type != SQLITE_NULL) {
      const void* data =
          type == SQLITE_TEXT ? sqlite3_value_text(column) : sqlite3_value_blob(column);
      const std::int64_t length = sqlite3_value_bytes(column);
      add(length);
      flush();
      if (length > 0) {
        bytes.append(static_cast<const char*>(data), static_cast<std::size_t>(length));
      }
    }
  }
  flush();
}

std::string Statement::blob() {
  const auto* bytes = static_cast<const char*>(sqlite3_column_blob(handle_.get(), column_));
  const auto size = static_cast<std::size_t>(sqlite3_column_bytes(handle_.get(), column_++));
  return bytes == nullptr ? "" : std::string(bytes, size);
}
std::string_view Statement::view() {
  const auto* bytes = static_cast<const char*>(sqlite3_column_blob(handle_.get(), column_));
  const auto size = static_cast<std::size_t>(sqlite3_column_bytes(handle_.get(), column_++));
  return bytes == nullptr ? std::string_view{} : std::string_view(bytes, size);
}
std::string Statement::text() {
  const auto* bytes = sqlite3_column_text(handle_.get(), column_);
  const auto size = static_cast<std::size_t>(sqlite3_column_bytes(handle_.get(), column_++));
  return bytes == nullptr ? "" : std::string(reinterpret_cast<const char*>(bytes), size);
}

}  // namespace loopbench::harness

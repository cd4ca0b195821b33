/// Thin wrapper around SQLite with exceptions, and hashes of rows.
#pragma once

#include <cmath>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/bags/sqlite_file.hpp"
#include "harness/sweep/model/shared_text.hpp"
#include "harness/sweep/text/hash.hpp"

struct sqlite3_value;

namespace loopbench::harness {

class Statement;

/// What to do with a file whose structure is damaged.
inline constexpr const char* kRecoverAdvice =
    "`sqlite3 FILE .recover | sqlite3 NEW_FILE` saves the readable rows, of which `run` recomputes "
    "incomplete cells; --fresh starts a new store";

/// Names of databases in memory, which connections of this process share, begin with this.
inline constexpr std::string_view kMemoryPrefix = "file:/loopbench-memory-";

/// The values of one row. The same values in the same order have the same hash, by which readers
/// notice rows that have changed since they were written, are missing or were added. Not
/// cryptographic: it detects accidental changes.
class RowHash {
 public:
  template <std::integral Integer>
  [[gnu::always_inline]] void add(Integer value) {
    add_bytes('i', static_cast<std::int64_t>(value));
  }
  [[gnu::always_inline]] void add(double value) {
    std::isnan(value) ? add_null() : add_bytes('r', value + 0.0);  // SQLite stores -0.0 as 0.0
  }
  [[gnu::always_inline]] void add(std::string_view bytes) {
    add_bytes('t', bytes.size());
    if (!bytes.empty()) std::memcpy(more(bytes.size()), bytes.data(), bytes.size());
  }
  void add_null() { *more(1) = 'n'; }
  void clear() { size_ = 0; }

  /// `before`: hash of the rows before this one; 0: it is the first.
  std::uint64_t after(std::uint64_t before) const {
    return hash_after(before, {bytes_.data(), size_});
  }

 private:
  template <class Value>
  [[gnu::always_inline]] void add_bytes(char type, Value value) {
    char* const at = more(1 + sizeof value);
    *at = type;
    std::memcpy(at + 1, &value, sizeof value);
  }

  /// Room at the end. Inlined in every build, as are the functions that use it: reading a store
  /// hashes millions of rows.
  [[gnu::always_inline]] char* more(std::size_t count) {
    if (size_ + count > bytes_.size()) grow(count);
    char* const out = bytes_.data() + size_;
    size_ += count;
    return out;
  }
  void grow(std::size_t count);

  std::vector<char> bytes_;
  std::size_t size_ = 0;
};

/// The values of a row that is visited.
struct RowValues {
  sqlite3_value** values;
  int count;

  std::int64_t integer(int column) const;

  /// Hash of the columns from `first` on, see RowHash. `before`: that of the rows before.
  std::uint64_t hashed(std::uint64_t before, int first) const;
};

/// Id of the definition of a score from the hash of its row: 48 bits, which take 6 bytes of a
/// score.
inline std::int64_t definition_id(std::uint64_t hash) {
  return static_cast<std::int64_t>(hash >> 16);
}

/// An open database file, in SQLite's defensive mode. Every failure throws InputError naming the
/// file and SQLite's reason.
class Database {
 public:
  enum class Mode { create, read };
  Database(const std::filesystem::path& file, Mode mode);

  void execute(const std::string& sql);
  Statement prepare(const std::string& sql);

  /// The first value of a query; 0 without a row.
  std::int64_t integer(const std::string& query);

  /// Names of the columns of a table, separated by commas.
  std::string columns_of(const std::string& table);

  /// Visits the rows of a table whose `cell` is from `first` to `last`, in the order of its key,
  /// with all columns: in less time than a statement that returns them.
  void for_each_row(const std::string& table,
                    std::int64_t first,
                    std::int64_t last,
                    const std::function<void(const RowValues&)>& visit);

  std::int64_t last_row() const;  ///< rowid of the last insert
  const std::string& file() const { return file_; }

  /// Throws InputError with the database's last message.
  [[noreturn]] void fail(const std::string& doing) const;

 private:
  std::string file_;
  SqliteFile handle_;
};

/// A blob to bind; not copied: must live until the statement has run.
struct Blob {
  std::string_view bytes;
  operator std::string_view() const { return bytes; }  // NOLINT(google-explicit-constructor)
};

/// A prepared statement; parameters and columns are accessed in order, starting at the first.
class Statement {
 public:
  /// Binds the next parameters: numbers, texts, blobs, nullptr, or optionals of these.
  template <class... Values>
  Statement& bind(const Values&... values) {
    (bind_one(values), ...);
    return *this;
  }

  /// Binds the values of a row, and then their hash.
  template <class... Values>
  Statement& bind_hashed(const Values&... values) {
    RowHash row;
    (row.add(values), ...);
    return bind(values..., row.after(0));
  }

  /// Runs to completion and resets for the next binding.
  void run();

  /// Ends an iteration over rows and resets for the next binding.
  void reset();

  /// Advances to the next row; false if there is none.
  bool step();

  /// Reads the next columns.
  template <class... Values>
  void read(Values&... values) {
    (read_one(values), ...);
  }
  std::int64_t integer();
  std::string text();       ///< text or blob
  std::string_view view();  ///< the same, valid until the next step

  /// Hash of the columns from `first` on but the last `without`, see RowHash. `before`: that of the
  /// rows before.
  std::uint64_t hashed(std::uint64_t before, int first, int without = 0) const;

 private:
  friend class Database;
  Statement(Database& database, sqlite3_stmt* handle) : database_(&database), handle_(handle) {}
  void expect(int code, const char* doing) const;

  template <std::integral Integer>
  void bind_one(Integer value) {
    bind_integer(static_cast<std::int64_t>(value));
  }
  void bind_integer(std::int64_t value);
  void bind_one(double value);
  void bind_one(std::string_view value);
  void bind_one(Blob value);
  void bind_one(std::nullptr_t);
  template <class T>
  void bind_one(const std::optional<T>& value) {
    value ? bind_one(*value) : bind_one(nullptr);
  }

  template <std::integral Integer>
  void read_one(Integer& value) {
    value = static_cast<Integer>(integer());
  }
  void read_one(double& value);
  void read_one(std::string& value) { value = view(); }
  void read_one(SharedText& value) {
    const std::string_view now = view();
    if (value.text() != now) value = now;  // neighbouring rows mostly have the same texts
  }
  template <class T>
  void read_one(std::optional<T>& value) {
    const bool is_none = is_null();
    read_one(value.emplace());
    if (is_none) value.reset();
  }
  bool is_null() const;

  Database* database_;
  SqliteQuery handle_;
  int parameter_ = 0;
  int column_ = 0;
};

/// Transaction that is rolled back on destruction unless committed.
class Transaction {
 public:
  explicit Transaction(Database& database) : database_(database) {
    database_.execute("BEGIN IMMEDIATE");
  }
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;

  void commit() {
    database_.execute("COMMIT");
    open_ = false;
  }

 private:
  Database& database_;
  bool open_ = true;
};

}  // namespace loopbench::harness

/// Thin wrapper around SQLite with exceptions.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace loopbench::harness {

class Statement;

/// What to do with a file whose structure is damaged.
inline constexpr const char* kRecoverAdvice =
    "`sqlite3 FILE .recover | sqlite3 NEW_FILE` saves the readable rows, of which `run` recomputes "
    "incomplete cells; --fresh starts a new store";

/// An open database file, in SQLite's defensive mode. Every failure throws InputError naming the
/// file and SQLite's reason.
class Database {
 public:
  enum class Mode { create, read };
  Database(const std::filesystem::path& file, Mode mode);

  void execute(const std::string& sql);
  Statement prepare(const std::string& sql);

  std::int64_t last_row() const;  ///< rowid of the last insert
  const std::string& file() const { return file_; }

  /// Throws InputError with the database's last message.
  [[noreturn]] void fail(const std::string& doing) const;

 private:
  struct Close {
    void operator()(sqlite3* handle) const;
  };
  std::string file_;
  std::unique_ptr<sqlite3, Close> handle_;
};

/// A prepared statement; parameters and columns are accessed in order, starting at 0.
class Statement {
 public:
  Statement& bind(std::int64_t value);
  Statement& bind(double value);
  Statement& bind(const std::string& value);
  Statement& bind_blob(std::string_view bytes);  ///< not copied: must live until run()
  template <class T>
  Statement& bind(const std::optional<T>& value) {
    return value ? bind(*value) : bind_null();
  }
  Statement& bind_null();

  /// Runs to completion and resets for the next binding.
  void run();

  /// Ends an iteration over rows and resets for the next binding.
  void reset();

  /// Advances to the next row; false if there is none.
  bool step();
  std::int64_t integer();
  double real();
  std::optional<std::int64_t> maybe_integer();  ///< nullopt for NULL
  std::optional<double> maybe_real();           ///< nullopt for NULL
  std::string text();
  std::string blob();
  std::string_view view();  ///< text or blob, valid until the next step

  int columns() const;
  /// Unambiguous serialisation of types and values of the row's columns in [from, to). Valid until
  /// the next call.
  std::string_view bytes_of_columns(int from, int to);
  void append_columns(int from, int to, std::string& bytes);  ///< the same, after `bytes`

 private:
  friend class Database;
  struct Finalize {
    void operator()(sqlite3_stmt* handle) const;
  };
  Statement(Database& database, sqlite3_stmt* handle) : database_(&database), handle_(handle) {}
  void expect(int code, const char* doing) const;

  Database* database_;
  std::unique_ptr<sqlite3_stmt, Finalize> handle_;
  int parameter_ = 0;
  int column_ = 0;
  std::string bytes_;
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

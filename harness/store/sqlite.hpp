/// The little of SQLite that the store needs, with errors as exceptions.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

struct sqlite3;
struct sqlite3_stmt;

namespace loopbench {

class Statement;

/// An open database file. Every failure throws InputError naming the file and SQLite's reason.
class Database {
 public:
  enum class Mode { create, read };
  Database(const std::filesystem::path& file, Mode mode);

  void execute(const std::string& sql);
  Statement prepare(const std::string& sql);

  /// Throws InputError with the database's last message.
  [[noreturn]] void fail(const std::string& doing) const;

 private:
  struct Close {
    void operator()(sqlite3* handle) const;
  };
  std::string file_;
  std::unique_ptr<sqlite3, Close> handle_;
};

/// A prepared statement; parameters and columns count from 0 and are walked in order.
class Statement {
 public:
  Statement& bind(std::int64_t value);
  Statement& bind(double value);
  Statement& bind(const std::string& value);

  /// Runs to completion and makes ready for the next binding.
  void run();

  /// The next row, or false when there is none.
  bool step();
  std::int64_t integer();
  double real();
  std::string text();

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
};

}  // namespace loopbench

/// The results of one sweep in one SQLite file, written as cells finish.
///
/// Schema: `run(key, value)` says what was run; `cell` has a row per cell, `score` one per score,
/// `phase`, `count` and `note` what the method reported. Column names say their units; see
/// schema.cpp. Each cell is one transaction: a killed sweep leaves whole cells only.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "harness/run/result.hpp"
#include "harness/store/record.hpp"
#include "harness/store/sqlite.hpp"
#include "harness/sweep.hpp"

namespace loopbench {

class Store {
 public:
  /// A new file; one already there is kept as `previous.sqlite` beside it. Throws InputError.
  Store(const std::filesystem::path& file, const Sweep& sweep);
  ~Store();
  Store(const Store&) = delete;
  Store& operator=(const Store&) = delete;

  /// One transaction. Throws InputError, for example when the disk is full.
  void write(const Sweep& sweep, const CellResult& result);

 private:
  Database database_;
};

/// All records in cell order, whatever the order they were written in. `file` may be the folder
/// that holds results.sqlite. Throws InputError when it is not a store.
std::vector<Record> read_records(const std::filesystem::path& file);

/// The `run` table: config text, protocol, baseline, version.
std::map<std::string, std::string> read_run(const std::filesystem::path& file);

}  // namespace loopbench

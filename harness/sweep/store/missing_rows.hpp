/// Rows that are missing in the tables that describe a sweep: they have no neighbours whose hashes
/// would show that.
#pragma once

#include <map>
#include <set>
#include <string>

#include "harness/sweep/store/sqlite.hpp"
#include "harness/sweep/text/hash.hpp"

namespace loopbench::harness {

/// Keys of provenance, of cells or of rows, whose rows are not all there: a key is their hash.
inline std::set<std::string> incomplete_provenance(Database& database) {
  std::map<std::string, Fields> found;
  Statement cell = database.prepare("SELECT DISTINCT provenance_key FROM cell");
  while (cell.step()) found[cell.text()];
  Statement row =
      database.prepare("SELECT provenance_key, key, value FROM provenance ORDER BY 1, 2");
  while (row.step()) {
    Fields& fields = found[row.text()];
    fields.add(row.text());
    fields.add(row.text());
  }
  std::set<std::string> out;
  for (const auto& [key, fields] : found) {
    if (fields.hashed() != key) out.insert(key);
  }
  return out;
}

/// A key that every table run has and this one has not; empty: none.
inline std::string missing_run_value(Database& database) {
  for (const char* const key :
       {"loopbench", "sweep", "config", "protocol", "metrics", "methods", "baseline", "cells"}) {
    Statement row = database.prepare("SELECT 1 FROM run WHERE key = ?");
    if (!row.bind(std::string_view(key)).step()) return key;
  }
  return "";
}

}  // namespace loopbench::harness

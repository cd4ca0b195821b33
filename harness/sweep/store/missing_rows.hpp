/// Rows that are missing in the tables that describe a sweep: they have no neighbours whose hashes
/// would show that.
#pragma once

#include <map>
#include <set>
#include <string>

#include "harness/sweep/store/sqlite.hpp"
#include "harness/sweep/text/hash.hpp"

namespace loopbench::harness {

/// Keys of provenance that cells can have: those of rows, and that of no rows.
inline std::set<std::string> provenance_keys(Database& database) {
  std::set<std::string> out{Fields().hashed()};
  Statement row = database.prepare("SELECT DISTINCT provenance_key FROM provenance");
  while (row.step()) out.insert(row.text());
  return out;
}

/// Keys of provenance whose rows are not all there: a key is their hash.
inline std::set<std::string> incomplete_provenance(Database& database) {
  std::map<std::string, Fields> found;
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
  for (const char* const key : {"loopbench",
                                "sweep",
                                "config",
                                "protocol",
                                "alignment",
                                "metrics",
                                "methods",
                                "baseline",
                                "cells"}) {
    Statement row = database.prepare("SELECT 1 FROM run WHERE key = ?");
    if (!row.bind(std::string_view(key)).step()) return key;
  }
  return "";
}

}  // namespace loopbench::harness

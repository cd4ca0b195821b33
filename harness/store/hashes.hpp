/// Hashes of cells and of rows that cells share, which readers compare.
#pragma once

#include <cstdint>
#include <set>
#include <string>

#include "harness/store/schema.hpp"
#include "harness/store/sqlite.hpp"

namespace loopbench::harness {

/// Sets the hashes of a cell. Call after any of its rows has changed. O(bytes).
void set_hashes(Database& database, std::int64_t id);

/// Hash of the rows of a cell's trace. O(bytes).
std::uint64_t trace_hash(Database& database, std::int64_t id);

/// The first columns of the rows that have changed. O(bytes).
std::set<std::string> damaged_rows(Database& database, const SharedTable& table);

/// Removes the rows with these keys, and returns the keys.
std::set<std::string> remove_damaged_rows(Database& database, const SharedTable& table);

/// Throws InputError naming the first row of run, provenance or input that has changed.
void require_intact_descriptions(Database& database);

/// Ids of the definitions of scores that have not changed.
std::set<std::int64_t> intact_definitions(Database& database);

/// Sets a value of the table run.
void set_run_value(Database& database, const std::string& key, const std::string& value);

/// Throws InputError naming the part `what` of `file` that has changed.
[[noreturn]] void throw_damaged(const std::string& file, const std::string& what);

}  // namespace loopbench::harness

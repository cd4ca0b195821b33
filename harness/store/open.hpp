/// Opens a finished store for reading.
#pragma once

#include <filesystem>

#include "harness/store/sqlite.hpp"

namespace loopbench::harness {

/// `given`, or results.sqlite if it is a folder. Throws InputError if the file does not exist.
std::filesystem::path store_file(const std::filesystem::path& given);

/// Opens the database in a read transaction, which does not see concurrent writes. Throws
/// InputError if it is not a store of this schema.
Database open_store(const std::filesystem::path& given);

/// Creates the tables of an empty store.
void create_tables(Database& database);

/// Throws InputError naming `file` if the schema differs from this program's.
void check_schema(Database& database, const std::filesystem::path& file);

}  // namespace loopbench::harness

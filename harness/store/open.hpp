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

/// Whether it has no tables: its writer was killed before the first transaction.
bool is_empty(Database& database);

/// Whether the file exists and is not empty. Throws InputError if it is not a database.
bool is_stored(const std::filesystem::path& file);

/// Throws InputError naming `file` if the schema is of another version, or naming the object if the
/// file has other tables, views, indexes or triggers than this program creates.
void check_schema(Database& database, const std::filesystem::path& file);

}  // namespace loopbench::harness

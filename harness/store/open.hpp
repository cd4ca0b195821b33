/// Opens and creates stores.
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

/// Whether a file has no tables: the process that created it was killed before it wrote any.
bool has_no_tables(Database& database);
bool has_no_tables(const std::filesystem::path& file);

/// Throws InputError naming `file` if its schema differs from this program's: another version, or
/// tables, views, indexes or triggers that are missing, changed or added.
void check_schema(Database& database, const std::filesystem::path& file);

}  // namespace loopbench::harness

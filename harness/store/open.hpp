/// Opening a finished store for reading.
#pragma once

#include <filesystem>

#include "harness/store/sqlite.hpp"

namespace loopbench {

/// `given`, or results.sqlite in the folder it is. Throws InputError when there is none.
std::filesystem::path store_file(const std::filesystem::path& given);

/// Within a transaction for reading, which ends with it: what a sweep writes meanwhile is not seen.
/// Throws InputError when it is not a store of this schema.
Database open_store(const std::filesystem::path& given);

/// Throws InputError naming `file` unless the schema is this program's.
void check_schema(Database& database, const std::filesystem::path& file);

}  // namespace loopbench

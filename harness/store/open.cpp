#include "harness/store/open.hpp"

#include "datasets/core/error.hpp"
#include "harness/store/schema.hpp"

namespace loopbench::harness {

std::filesystem::path store_file(const std::filesystem::path& given) {
  const std::filesystem::path file =
      std::filesystem::is_directory(given) ? given / "results.sqlite" : given;
  if (!std::filesystem::exists(file)) {
    throw InputError(file.string() + ": file not found, expected a store of results");
  }
  if (!std::filesystem::is_regular_file(file)) {  // SQLite would wait for a pipe
    throw InputError(file.string() + ": is not a regular file, expected a store of results");
  }
  return file;
}

void create_tables(Database& database) {
  database.execute(kSchema);
  database.execute("PRAGMA user_version = " + std::to_string(kSchemaVersion));
}

void check_schema(Database& database, const std::filesystem::path& file) {
  Statement version = database.prepare("PRAGMA user_version");
  const std::int64_t found = version.step() ? version.integer() : 0;
  if (found == kSchemaVersion) return;
  const bool older = found > 0 && found < kSchemaVersion;
  throw InputError(file.string() + ": is not a store of results of this version (schema " +
                   std::to_string(found) + ", expected " + std::to_string(kSchemaVersion) + ")" +
                   (older ? "; run its config again: --fresh keeps it as previous-N.sqlite" : ""));
}

Database open_store(const std::filesystem::path& given) {
  const std::filesystem::path file = store_file(given);
  Database database(file, Database::Mode::read);
  check_schema(database, file);
  database.execute("BEGIN");
  return database;
}

}  // namespace loopbench::harness

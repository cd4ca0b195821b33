#include "harness/store/open.hpp"

#include <map>
#include <utility>

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

namespace {

/// Objects of the schema, by "TYPE NAME", with their SQL; not those that SQLite makes itself.
std::map<std::string, std::string> objects_of(Database& database) {
  std::map<std::string, std::string> out;
  Statement row = database.prepare(
      "SELECT type || ' ' || name, sql FROM sqlite_master WHERE name NOT LIKE 'sqlite\\_%' ESCAPE "
      "'\\'");
  while (row.step()) {
    std::string name = row.text();
    out.emplace(std::move(name), row.text());
  }
  return out;
}

/// A trigger, view or changed table could change what is read or written.
void reject_other_objects(Database& database, const std::filesystem::path& file) {
  static const std::map<std::string, std::string> expected = [] {
    Database empty(":memory:", Database::Mode::create);
    create_tables(empty);
    return objects_of(empty);
  }();
  const std::map<std::string, std::string> found = objects_of(database);
  for (const auto& [name, sql] : found) {
    const auto own = expected.find(name);
    if (own == expected.end()) {
      throw InputError(file.string() + ": has the " + name +
                       ", which is not part of a store; remove it with 'sqlite3 " + file.string() +
                       "', or start a new store with --fresh");
    }
    if (own->second != sql) {
      throw InputError(file.string() + ": its " + name + " differs from that of a store; " +
                       recovery_advice(file));
    }
  }
  for (const auto& [name, sql] : expected) {
    if (found.contains(name)) continue;
    throw InputError(file.string() + ": is damaged: its " + name + " is missing; " +
                     recovery_advice(file));
  }
}

}  // namespace

bool is_empty(Database& database) {
  Statement count = database.prepare("SELECT count(*) FROM sqlite_master");
  return count.step() && count.integer() == 0;
}

bool is_stored(const std::filesystem::path& file) {
  if (!std::filesystem::is_regular_file(file)) return std::filesystem::exists(file);
  Database database(file, Database::Mode::read);
  return !is_empty(database);
}

void check_schema(Database& database, const std::filesystem::path& file) {
  Statement version = database.prepare("PRAGMA user_version");
  const std::int64_t found = version.step() ? version.integer() : 0;
  if (found == kSchemaVersion) return reject_other_objects(database, file);
  if (found == 0 && is_empty(database)) {
    throw InputError(file.string() + ": is empty, expected a store of results; run its config");
  }
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

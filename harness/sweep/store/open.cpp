#include "harness/sweep/store/open.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <map>
#include <system_error>

#include "datasets/core/error.hpp"
#include "harness/sweep/store/schema.hpp"
#include "harness/sweep/store/stored_cells.hpp"

namespace loopbench::harness {
namespace {

/// The statements that created all objects, by "table NAME", "trigger NAME", ...
std::map<std::string, std::string> objects(Database& database) {
  std::map<std::string, std::string> out;
  Statement row = database.prepare(
      "SELECT type || ' ' || name, sql FROM sqlite_master WHERE name NOT LIKE 'sqlite!_%' ESCAPE "
      "'!'");
  while (row.step()) {
    const std::string name = row.text();
    out.emplace(name, row.text());
  }
  return out;
}

void check_objects(Database& database, const std::filesystem::path& file) {
  static const std::map<std::string, std::string> kExpected = [] {
    Database empty(":memory:", Database::Mode::create);
    create_tables(empty);
    return objects(empty);
  }();
  const std::map<std::string, std::string> found = objects(database);
  const auto reject = [&](const std::string& name, const std::string& what) {
    throw InputError(file.string() + ": is not a store of results as loopbench writes them: the " +
                     name + " " + what);
  };
  for (const auto& [name, sql] : found) {
    const auto same = kExpected.find(name);
    if (same == kExpected.end()) reject(name, "does not belong to it; drop it");
    if (same->second != sql) reject(name, "has another definition");
  }
  for (const auto& [name, sql] : kExpected) {
    if (!found.contains(name)) reject(name, "is missing");
  }
}

void sync_path(const std::filesystem::path& path) {
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  const bool is_synced = descriptor >= 0 && fsync(descriptor) == 0;
  const std::error_code reason(errno, std::generic_category());
  if (descriptor >= 0) close(descriptor);
  if (!is_synced) throw std::filesystem::filesystem_error("cannot be synced", path, reason);
}

}  // namespace

std::filesystem::path memory_store() {
  static std::atomic<int> count = 0;
  return std::string(kMemoryPrefix) + std::to_string(count++) + "?vfs=memdb";
}

bool is_memory_store(const std::filesystem::path& file) {
  return file.native().starts_with(kMemoryPrefix);
}

std::filesystem::path store_file(const std::filesystem::path& given) {
  if (is_memory_store(given)) return given;
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

bool has_no_tables(Database& database) {
  return database.integer("SELECT count(*) FROM sqlite_master") == 0;
}

bool has_no_tables(const std::filesystem::path& file) {
  Database database(file, Database::Mode::read);
  return has_no_tables(database);
}

void check_schema(Database& database, const std::filesystem::path& file) {
  if (has_no_tables(database)) {
    throw InputError(file.string() +
                     ": is not a store of results, it has no tables; if its sweep was ended before "
                     "the first cell, run it again");
  }
  const std::int64_t found = database.integer("PRAGMA user_version");
  if (found == kSchemaVersion) {
    check_objects(database, file);
    return;
  }
  const bool older = found > 0 && found < kSchemaVersion;
  throw InputError(file.string() + ": is not a store of results of this version (schema " +
                   std::to_string(found) + ", expected " + std::to_string(kSchemaVersion) + ")" +
                   (older ? "; run its config again: --fresh keeps it as previous-N.sqlite" : ""));
}

Database open_store(const std::filesystem::path& given) {
  const std::filesystem::path file = store_file(given);
  Database database(file, Database::Mode::read);
  const bool is_foreign = !is_memory_store(file);
  if (is_foreign) check_schema(database, file);
  database.execute("BEGIN");
  if (is_foreign) require_intact_descriptions(database);
  return database;
}

namespace {

/// Creates a folder and those above it. Returns those that were missing, the outermost first.
std::vector<std::filesystem::path> create_folders(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> missing;
  std::error_code error;
  for (std::filesystem::path at = folder; !at.empty() && !std::filesystem::exists(at, error);
       at = at.parent_path()) {
    missing.insert(missing.begin(), at);
  }
  std::filesystem::create_directories(folder, error);
  if (error) throw InputError(folder.string() + ": cannot be written: " + error.message());
  return missing;
}

/// Whether the open folder is still the one of this name: its last user can have removed it.
bool is_same_folder(int descriptor, const std::filesystem::path& folder) {
  struct stat opened {};
  struct stat named {};
  return fstat(descriptor, &opened) == 0 && stat(folder.c_str(), &named) == 0 &&
         opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder) {
  constexpr int kMostAttempts = 100;
  for (int attempt = 0; attempt < kMostAttempts; ++attempt) {
    for (const std::filesystem::path& each : create_folders(folder)) created_.push_back(each);
    descriptor_ = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    int reason = descriptor_ < 0 || flock(descriptor_, LOCK_EX | LOCK_NB) != 0 ? errno : 0;
    if (reason == 0 && is_same_folder(descriptor_, folder)) return;
    if (descriptor_ >= 0) close(descriptor_);
    if (reason == EWOULDBLOCK) {
      throw InputError(folder.string() +
                       ": another sweep is writing its results here, or a merge; wait for it, "
                       "or choose another folder with --out");
    }
    if (reason != 0 && reason != ENOENT) {
      throw InputError(folder.string() + ": cannot be locked: " + std::strerror(reason));
    }
  }
  throw InputError(folder.string() + ": cannot be locked: other processes keep removing it");
}

FolderLock::~FolderLock() {
  std::error_code not_empty;
  for (auto each = created_.rbegin(); each != created_.rend(); ++each) {
    std::filesystem::remove(*each, not_empty);
  }
  close(descriptor_);
}

std::filesystem::path folder_of(const std::filesystem::path& file) {
  return file.has_parent_path() ? file.parent_path() : ".";
}

void rename_durably(const std::filesystem::path& from, const std::filesystem::path& to) {
  sync_path(from);
  std::filesystem::rename(from, to);
  sync_path(folder_of(to));
}

void include_log(const std::filesystem::path& file) {
  {
    Database database(file, Database::Mode::read);
    database.execute("PRAGMA wal_checkpoint(TRUNCATE); PRAGMA journal_mode = DELETE");
  }
  std::error_code none;
  const std::filesystem::path log = file.string() + "-wal";
  if (!std::filesystem::exists(log, none) || std::filesystem::file_size(log, none) == 0) return;
  throw InputError(file.string() + ": cannot be replaced while another program reads it");
}

void remove_database(const std::filesystem::path& file) {
  std::error_code none;
  for (const char* tail : {"", "-wal", "-shm", "-journal"}) {
    std::filesystem::remove(file.string() + tail, none);
  }
}

}  // namespace loopbench::harness

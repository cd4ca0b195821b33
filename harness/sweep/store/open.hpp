/// Opens, creates and locks stores.
#pragma once

#include <filesystem>
#include <vector>

#include "harness/sweep/store/sqlite.hpp"

namespace loopbench::harness {

/// A new name of a store in memory, which exists while a connection to it is open.
std::filesystem::path memory_store();
bool is_memory_store(const std::filesystem::path& file);

/// `given`, or results.sqlite if it is a folder. Throws InputError if the file does not exist.
std::filesystem::path store_file(const std::filesystem::path& given);

/// Opens the database in a read transaction, which does not see concurrent writes. Throws
/// InputError if it is not a store of this schema, or its tables run, provenance or input are
/// damaged.
Database open_store(const std::filesystem::path& given);

/// Creates the tables of an empty store.
void create_tables(Database& database);

/// Whether a file has no tables: the process that created it was killed before it wrote any.
bool has_no_tables(Database& database);
bool has_no_tables(const std::filesystem::path& file);

/// Throws InputError naming `file` if its schema differs from this program's: another version, or
/// tables, views, indexes or triggers that are missing, changed or added.
void check_schema(Database& database, const std::filesystem::path& file);

/// Locks a folder, so that one command at a time creates or writes a store there, until destroyed
/// or until the process ends; a killed process leaves no lock behind. Creates the folder, and
/// removes it at the end if it has stayed empty.
class FolderLock {
 public:
  /// Throws InputError if another process holds the lock, or the folder cannot be created or
  /// opened.
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  std::vector<std::filesystem::path> created_;  ///< the outermost first
  int descriptor_ = -1;
};

/// The folder of a file given by a path.
std::filesystem::path folder_of(const std::filesystem::path& file);

/// Waits until the file is on the disk, renames it, and waits until the new name is, too. Throws
/// std::filesystem::filesystem_error.
void rename_durably(const std::filesystem::path& from, const std::filesystem::path& to);

/// Puts all of a store into its one file: no log of a killed process is left, which would belong to
/// a file that replaces it. Throws InputError if other programs that read it prevent that.
void include_log(const std::filesystem::path& file);

/// Removes a file and SQLite's journals of it. Ignores errors.
void remove_database(const std::filesystem::path& file);

}  // namespace loopbench::harness

/// Databases that are written under another name until they are complete.
#pragma once

#include <filesystem>

namespace loopbench::harness {

/// Waits until the file is on the disk, renames it, and waits until the new name is, too. Throws
/// std::filesystem::filesystem_error.
void rename_file(const std::filesystem::path& from, const std::filesystem::path& to);

/// Removes all files in its folder whose names begin with that of `file`: SQLite's journals, too.
/// Ignores errors.
void remove_files_of(const std::filesystem::path& file);

}  // namespace loopbench::harness

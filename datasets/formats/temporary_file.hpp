/// Temporary files of replace_file(), and what killed processes leave of them.
#pragma once

#include <filesystem>

namespace loopbench {

/// Creates a new, empty file `.loopbench-<16 hexadecimal digits>` in `folder` and locks it (flock)
/// until every copy of the descriptor is closed. Returns the descriptor; -1 and errno if the folder
/// cannot be written.
int create_temporary_file(const std::filesystem::path& folder, std::filesystem::path& file);

/// Removes this user's temporary files in `folder` that no process has locked: those of processes
/// that were killed. Leaves what cannot be removed, or locked as on some network file systems.
/// O(files in the folder).
void remove_abandoned_files(const std::filesystem::path& folder);

}  // namespace loopbench

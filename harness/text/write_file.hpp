/// Files that appear whole or not at all, and destroy nothing that was not meant.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace loopbench {

/// "-": standard output, as in other tools.
bool is_dash(const std::filesystem::path& file);

/// Throws InputError when `option` is given a dash and needs a folder or a database.
void require_no_dash(const std::string& option, const std::filesystem::path& file);

/// Writes beside and renames over, so that a reader never meets half a file; folders that are
/// missing are made. A symbolic link is followed. What is there and no ordinary file (a pipe, a
/// device, this process's standard output) is written into, not replaced; "-" is standard output.
/// Throws InputError when
/// folder or disk refuses, and for a folder or a file that nobody may write.
void write_file(const std::filesystem::path& file, const std::string& text);

/// Throws InputError when `file` is one of `inputs`, by whatever name. What is not there is none.
void refuse_to_overwrite(const std::vector<std::filesystem::path>& inputs,
                         const std::filesystem::path& file);

}  // namespace loopbench

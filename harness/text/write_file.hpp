/// Atomic writing of files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace loopbench::harness {

/// "-" means standard output.
bool is_dash(const std::filesystem::path& file);

/// Throws InputError if `option` is a dash but needs a folder or a database.
void reject_standard_output(const std::string& option, const std::filesystem::path& file);

/// Writes a temporary file and renames it, so that readers never see a partial file; creates
/// missing folders. Follows symbolic links. Writes into an existing file that is not a regular file
/// (a pipe, a device, this process's standard output) instead of replacing it; "-" is standard
/// output. Throws InputError if the folder or file cannot be written, or if `file` is a folder.
void write_file(const std::filesystem::path& file, const std::string& text);

/// Throws InputError if `file` is one of `inputs`, under any name. A missing file is none of them.
void reject_overwriting(const std::vector<std::filesystem::path>& inputs,
                        const std::filesystem::path& file);

}  // namespace loopbench::harness

/// Output files of commands.
#pragma once

#include <filesystem>
#include <string>

namespace loopbench::harness {

/// "-" means standard output.
bool is_dash(const std::filesystem::path& file);

/// Throws InputError if `option` is a dash but needs a folder or a database.
void reject_standard_output(const std::string& option, const std::filesystem::path& file);

/// Writes a file that the user names: replace_file() with Target::named, so symbolic links are
/// followed; "-" is standard output. Creates missing folders. Throws InputError.
void write_file(const std::filesystem::path& file, const std::string& text);

/// Writes a file whose name the program chooses, in a folder of results: replace_file() with
/// Target::own, so a symbolic link of that name is replaced. Creates missing folders. Throws
/// InputError.
void write_result(const std::filesystem::path& file, const std::string& text);

}  // namespace loopbench::harness

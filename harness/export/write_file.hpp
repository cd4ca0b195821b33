/// Files that appear whole or not at all.
#pragma once

#include <filesystem>
#include <string>

namespace loopbench {

/// Writes beside and renames over. Throws InputError when the folder or disk refuses.
void write_file(const std::filesystem::path& file, const std::string& text);

}  // namespace loopbench

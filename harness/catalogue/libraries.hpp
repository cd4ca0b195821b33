/// Shared libraries of this process.
#pragma once

#include <filesystem>
#include <vector>

namespace loopbench {

/// Files of the shared libraries that the program needs, directly or through each other, without
/// symbolic links (so that their names hold their versions), sorted.
std::vector<std::filesystem::path> program_libraries();

/// Files of those that a loaded plugin needs and the program does not, sorted. Empty when the
/// plugin is not loaded.
std::vector<std::filesystem::path> plugin_libraries(const std::filesystem::path& plugin);

}  // namespace loopbench

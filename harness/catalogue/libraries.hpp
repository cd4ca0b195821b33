/// Shared libraries of this process.
#pragma once

#include <filesystem>
#include <vector>

namespace loopbench::harness {

/// Files of the shared libraries that the program needs directly or indirectly, sorted, with
/// symbolic links resolved (so that their names contain the versions).
std::vector<std::filesystem::path> program_libraries();

/// Files of the libraries that a loaded plugin needs but the program does not, sorted. Empty if the
/// plugin is not loaded.
std::vector<std::filesystem::path> plugin_libraries(const std::filesystem::path& plugin);

}  // namespace loopbench::harness

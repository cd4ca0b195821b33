/// Shared libraries of this process.
#pragma once

#include <filesystem>
#include <vector>

namespace loopbench::harness {

/// Files of the shared libraries that are loaded at the first call, sorted, with symbolic links
/// resolved (so that their names contain the versions). Call it before a plugin is loaded.
const std::vector<std::filesystem::path>& program_libraries();

/// Files of the libraries that were loaded since then, with the plugin, sorted.
std::vector<std::filesystem::path> plugin_libraries(const std::filesystem::path& plugin);

}  // namespace loopbench::harness

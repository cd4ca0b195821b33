#pragma once

#include <filesystem>
#include <vector>

#include "harness/plugin/plugin.hpp"

namespace loopbench::harness {

/// Loads the entries of a shared object, in their order. Throws InputError with the file and the
/// reason if it cannot be used: not loadable, no LOOPBENCH_PLUGIN line, another ABI. The object
/// stays loaded until the process ends, because the entries point into its code.
std::vector<PluginEntry> load_plugin(const std::filesystem::path& object);

}  // namespace loopbench::harness

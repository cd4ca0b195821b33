/// Shared objects of users. Their code runs only in processes that use it: a plugin is described
/// by a process of its own, and loaded by the first call of one of its functions.
#pragma once

#include <filesystem>
#include <vector>

#include "harness/sweep/catalogue/plugin.hpp"

namespace loopbench::harness {

/// Loads the entries of a shared object into this process, in their order. Throws InputError with
/// the file and the reason if it cannot be used: not loadable, no LOOPBENCH_PLUGIN line, another
/// ABI. The object stays loaded until the process ends, because the entries point into its code.
std::vector<PluginEntry> load_plugin(const std::filesystem::path& object);

struct DescribedPlugin {
  /// Options are checked in processes of their own; `make`, `load` and `score` load the plugin into
  /// the calling process.
  std::vector<PluginEntry> entries;
  std::vector<std::filesystem::path> libraries;  ///< that it loads, see plugin_libraries()
};

/// What the plugin has, without running its code in this process. Throws InputError as
/// load_plugin(), and if loading it ends the process or takes longer than `seconds`.
DescribedPlugin describe_plugin(const std::filesystem::path& object, double seconds = 60.0);

}  // namespace loopbench::harness

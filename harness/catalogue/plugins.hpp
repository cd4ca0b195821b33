#pragma once

#include <filesystem>
#include <vector>

#include "methods/method.hpp"

namespace loopbench::harness {

/// Loads the methods of a shared object. Throws InputError with the file and the reason if it
/// cannot be used: not loadable, no LOOPBENCH_PLUGIN line, another ABI. The object stays loaded
/// until the process ends, because the entries point into its code.
std::vector<methods::MethodEntry> load_plugin(const std::filesystem::path& object);

}  // namespace loopbench::harness

#pragma once

#include <filesystem>
#include <vector>

#include "methods/method.hpp"

namespace loopbench {

/// Methods a shared object brings. Throws InputError naming the file and the reason when it may not
/// be used: not loadable, no LOOPBENCH_PLUGIN line, another ABI.
/// The object stays loaded until the process ends: the entries point into its code.
std::vector<MethodEntry> load_plugin(const std::filesystem::path& object);

}  // namespace loopbench

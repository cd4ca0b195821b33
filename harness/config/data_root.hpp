/// Search folders for the relative paths of a config.
#pragma once

#include <string>

#include "datasets/dataset.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench::harness {

/// Searches in the config's folder, then in `data` if given. Throws InputError if that is not a
/// folder.
DataRoot data_root(const Sweep& sweep, const std::string& data);

}  // namespace loopbench::harness

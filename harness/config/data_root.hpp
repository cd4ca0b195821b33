/// Where a config's relative paths are looked for.
#pragma once

#include <string>

#include "datasets/dataset.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench {

/// Beside the config, then in `data` when given. Throws InputError when that is no folder.
DataRoot data_root(const Sweep& sweep, const std::string& data);

}  // namespace loopbench

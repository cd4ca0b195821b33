/// Configs that are installed with the program.
#pragma once

#include <string>

namespace loopbench::harness {

/// `given` if it is a file or contains a slash or a dot; otherwise the file `given`.yaml among the
/// installed configs (share/loopbench/configs next to the program's folder), if it exists.
std::string config_path(const std::string& given);

}  // namespace loopbench::harness

/// Keys of the maps of a config: what is accepted, and what the schema describes.
#pragma once

#include <string>
#include <vector>

namespace loopbench::harness {

struct ConfigKey {
  std::string name;
  std::string help;  ///< meaning, with the unit in brackets
};

/// Keys of the config ("") or of its maps `limits`, `timing`, `table` and `exclude`. Throws
/// std::out_of_range for another name.
const std::vector<ConfigKey>& config_keys(const std::string& map);

/// Their names.
std::vector<std::string> config_key_names(const std::string& map);

}  // namespace loopbench::harness

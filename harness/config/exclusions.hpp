/// Exclusions of a config that exclude nothing.
#pragma once

#include <string>

#include "harness/config/yaml.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench::harness {

/// Throws InputError `file:line:` for a pattern of `exclude` that matches no label of the sweep: it
/// is misspelt, and its cells would be computed. The entries of the node are sweep.exclude.
void require_matches(const YamlNode& exclude, const Sweep& sweep, const std::string& file);

}  // namespace loopbench::harness

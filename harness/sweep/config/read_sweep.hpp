/// Reads a YAML config into a Sweep, resolving all names and checking all options.
#pragma once

#include <filesystem>

#include "harness/sweep/catalogue/catalogue.hpp"
#include "harness/sweep/model/sweep.hpp"

namespace loopbench::harness {

/// `given` and the shared objects that a config lists under `plugins:`, relative to its folder:
/// what to load before the names in the config are resolved. Throws InputError unless it is YAML.
std::vector<std::filesystem::path> with_config_plugins(std::vector<std::filesystem::path> given,
                                                       const std::filesystem::path& file);

/// Patterns in paths are searched in the config's folder, then in `data` if given. Throws one
/// InputError with up to ten lines `file:line: what`, with suggestions for misspelled names.
Sweep read_sweep(const std::filesystem::path& file,
                 const Catalogue& catalogue,
                 const std::filesystem::path& data = {});

/// The same from text; `file` is used for messages and the sweep's name.
Sweep parse_sweep(const std::string& text,
                  const std::filesystem::path& file,
                  const Catalogue& catalogue,
                  const std::filesystem::path& data = {});

}  // namespace loopbench::harness

/// Reads a YAML config into a Sweep, resolving all names and checking all options.
#pragma once

#include <filesystem>

#include "harness/catalogue/catalogue.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench::harness {

/// Throws InputError `file:line: what` with a suggestion for misspelled names.
Sweep read_sweep(const std::filesystem::path& file, const Catalogue& catalogue);

/// The same from text; `file` is used for messages and the sweep's name.
Sweep parse_sweep(const std::string& text,
                  const std::filesystem::path& file,
                  const Catalogue& catalogue);

}  // namespace loopbench::harness

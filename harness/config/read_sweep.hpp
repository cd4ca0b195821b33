/// From a YAML file to a Sweep: everything named is looked up, every option checked, here.
#pragma once

#include <filesystem>

#include "harness/catalogue/catalogue.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench {

/// Throws InputError `file:line: what` with a suggestion for a slip, before anything is run.
Sweep read_sweep(const std::filesystem::path& file, const Catalogue& catalogue);

/// The same from text; `file` is only for messages and the sweep's name.
Sweep parse_sweep(const std::string& text,
                  const std::filesystem::path& file,
                  const Catalogue& catalogue);

}  // namespace loopbench

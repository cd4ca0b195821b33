/// The chart of `check --history`.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/compare/baseline.hpp"

namespace loopbench::harness {

struct StoredBaseline {
  std::string file;
  Baseline baseline;
};

/// "a.json (0.3.0, 71e77bd962c0)": version and commit of its build; a baseline states no date.
std::string described(const StoredBaseline& stored);

/// Draws the first score that `filters` select, with its first limited statistic: for each method
/// its mean over the runs that both files have, divided by that of the first file with the method.
/// Methods that changed most come first, because long legends are cut. Throws InputError if no
/// score with a limit is selected.
void draw_history(const std::vector<StoredBaseline>& all,
                  const std::filesystem::path& file,
                  const std::vector<std::string>& filters);

}  // namespace loopbench::harness

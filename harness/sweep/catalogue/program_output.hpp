/// Outputs of programs of the dataset `command`, which are kept between sweeps.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

namespace loopbench::harness {

struct ProgramCost {
  double seconds = 0.0;          ///< wall time
  std::int64_t peak_memory = 0;  ///< [bytes]
};

struct ProgramOutput {
  std::filesystem::path trajectory;  ///< what else the program wrote is next to it
  ProgramCost cost;                  ///< of the run that wrote it
};

/// A regular file, not a link to one.
bool is_own_file(const std::filesystem::path& file);

/// Returns what is kept for `key` in the folder `all`, neither incomplete nor changed since, or
/// else what `run` writes to the file that it is given. Processes that need the same run wait for
/// it. Throws InputError if it cannot be kept, and what `run` throws.
ProgramOutput kept_output(
    const std::filesystem::path& all,
    const std::string& key,
    const std::function<ProgramCost(const std::filesystem::path& trajectory)>& run);

}  // namespace loopbench::harness

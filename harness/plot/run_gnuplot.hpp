/// Runs gnuplot as a process.
#pragma once

#include <string>

namespace loopbench::harness {

/// Returns what gnuplot writes to its standard output for a script. gnuplot opens no file of ours,
/// so the caller reports a full disk. Throws InputError if gnuplot is missing or fails.
std::string drawn_by_gnuplot(const std::string& script);

}  // namespace loopbench::harness

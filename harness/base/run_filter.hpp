/// Runs a program that reads its standard input and writes its standard output.
#pragma once

#include <string>
#include <vector>

namespace loopbench::harness {

struct FilterResult {
  int exit_code = 0;   ///< 128 + signal number if a signal ended it
  std::string output;  ///< of its standard output; standard error is ours
};

/// Starts `words` (searched in PATH, without a shell) and sends `input` while it reads the output,
/// so neither blocks. Throws std::system_error if the program cannot be started.
FilterResult run_filter(const std::vector<std::string>& words, const std::string& input = "");

}  // namespace loopbench::harness

/// State of a worker that a dataset could change for the cells and sequences after it.
#pragma once

#include <signal.h>
#include <sys/types.h>

#include <array>
#include <clocale>
#include <string>
#include <vector>

namespace loopbench::harness {

/// Restores signal handlers and mask, umask, current folder, locale and environment at the end of
/// its scope. Only in a process without threads that use them.
class ProcessState {
 public:
  ProcessState();
  ~ProcessState();
  ProcessState(const ProcessState&) = delete;
  ProcessState& operator=(const ProcessState&) = delete;

 private:
  std::array<struct sigaction, NSIG> actions_{};  ///< by signal
  sigset_t blocked_{};
  mode_t mask_ = 0;
  int folder_ = -1;  ///< descriptor of the current folder
  std::string locale_;
  std::vector<std::string> environment_;  ///< "NAME=value"
};

}  // namespace loopbench::harness

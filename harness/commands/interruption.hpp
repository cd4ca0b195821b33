#pragma once

#include <csignal>
#include <cstdlib>
#include <ctime>

#include "harness/commands/commands.hpp"
#include "harness/sweep/run/isolated_sweep.hpp"

namespace loopbench::harness {

inline StopRequests stop_requests = 0;
inline timespec last_interrupt{};

/// One interrupt can arrive twice: at the process and at its group.
inline bool is_repeated(const timespec& now) {
  const double seconds = static_cast<double>(now.tv_sec - last_interrupt.tv_sec) +
                         1e-9 * static_cast<double>(now.tv_nsec - last_interrupt.tv_nsec);
  return seconds < 0.2;
}

inline void note_interruption(int signal) {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  if (stop_requests == 0) {
    stop_requests = 1;
  } else if (signal != SIGINT || is_repeated(now)) {
    return;
  } else if (stop_requests == 1) {
    stop_requests = 2;
  } else {
    std::_Exit(kExitInterrupted);
  }
  last_interrupt = now;
}

/// Installs handlers for SIGINT, SIGTERM and SIGHUP and returns their requests, which have static
/// lifetime. The first signal requests to finish running cells, a later SIGINT to abandon them, and
/// one after that ends the program at once, which loses no finished cell.
inline const StopRequests& install_interrupt_handler() {
  std::signal(SIGINT, note_interruption);
  std::signal(SIGTERM, note_interruption);
  std::signal(SIGHUP, note_interruption);
  return stop_requests;
}

}  // namespace loopbench::harness

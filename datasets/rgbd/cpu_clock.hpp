/// CPU time of the current thread.
#pragma once

#include <ctime>

namespace loopbench::rgbd {

/// CPU time of the calling thread [s], independent of the load of the machine.
inline double cpu_seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace loopbench::rgbd

/// Time that a thread has worked.
#pragma once

#include <ctime>

namespace loopbench {

/// Of the calling thread [s]: what others do on the machine does not count.
inline double cpu_seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace loopbench

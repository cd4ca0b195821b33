/// Requests of the user to end a sweep early.
#pragma once

#include <atomic>

namespace loopbench::harness {

/// 0: none; 1: start no more cells; 2: also abandon the running ones, if they have processes.
using StopRequests = std::atomic<int>;

}  // namespace loopbench::harness

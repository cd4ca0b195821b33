#pragma once

#include <atomic>

namespace loopbench {

/// From now on SIGINT and SIGTERM only set the flag returned, which lives as long as the program.
const std::atomic<bool>& catch_interruption();

}  // namespace loopbench

#pragma once

#include <atomic>

namespace loopbench::harness {

/// Installs handlers for SIGINT, SIGTERM and SIGHUP that only set the returned flag, which has
/// static lifetime.
const std::atomic<bool>& install_interrupt_handler();

}  // namespace loopbench::harness

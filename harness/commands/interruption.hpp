#pragma once

#include "harness/run/isolated_sweep.hpp"

namespace loopbench::harness {

/// Installs handlers for SIGINT, SIGTERM and SIGHUP and returns their requests, which have static
/// lifetime. The first signal requests to finish running cells, a later SIGINT to abandon them, and
/// one after that ends the program at once, which loses no finished cell.
const StopRequests& install_interrupt_handler();

}  // namespace loopbench::harness

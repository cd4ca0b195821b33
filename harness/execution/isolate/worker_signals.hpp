/// Signal handlers of a worker.
#pragma once

#include <sys/types.h>

namespace loopbench::harness {

/// SIGINT, SIGTERM and SIGHUP are left to the sweep. SIGTSTP (Ctrl-Z) stops the running cell, which
/// is not in the process group of the terminal, and the worker, until SIGCONT or the end of the
/// sweep. `sweep`: the socket to it.
void install_worker_signals(int sweep);

/// The process group of the running cell, 0 if there is none.
void set_running_cell(pid_t group);

/// Restores the default actions in a cell, which is forked from the worker.
void restore_default_signals();

/// Whether the other end of the socket is closed.
bool has_sweep_ended();

}  // namespace loopbench::harness

/// The process of one cell, from its fork to its end.
#pragma once

#include <sys/types.h>

#include <vector>

#include "harness/execution/isolate/result_area.hpp"
#include "harness/execution/isolate/worker.hpp"

namespace loopbench::harness {

struct CellChild {
  const WorkerContext& context;
  const Cell& cell;
  const Sequence& sequence;
  pid_t worker = 0;
  int core = -1;  ///< to run on; -1: any
  int input = -1;
  int output = -1;  ///< standard output and error
  ResultArea& area;
  std::vector<int> kept;  ///< descriptors to keep open, apart from the standard streams
};

/// The highest core this process may use, since the first ones handle most interrupts.
int last_core();

/// In a process that a worker forked: it ends with the worker, has default signals and a process
/// group of its own, and cannot grow much beyond `memory` [bytes].
void detach_from_worker(pid_t worker, std::int64_t memory);

/// Sets the standard streams and closes all descriptors but them and `kept`.
void connect_streams(int input, int output, std::vector<int> kept);

/// In the forked process: detaches it from the worker, runs the cell and leaves the packed result
/// in the area.
[[noreturn]] void run_cell_and_exit(const CellChild& child);

}  // namespace loopbench::harness

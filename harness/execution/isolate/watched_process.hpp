/// Processes that a worker forks for code that may fail: limits, output, and the end of all that
/// they started.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "harness/execution/isolate/result_area.hpp"
#include "harness/external/scratch.hpp"
#include "harness/model/status.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench::harness {

/// How a process ended: with a result, or with the reason why it left none.
struct ProcessEnd {
  std::string_view result;  ///< valid until the next process
  Status status = Status::ok;
  std::string why;
  std::string signal;  ///< that ended it, for example "SIGSEGV"
};

/// What the forked process does; does not return. `output`: to the worker, for its streams.
using ProcessWork = std::function<void(ResultArea& area, int output)>;

/// Forks one process after another; each starts as a copy of the worker, with nothing of earlier
/// ones.
class WatchedProcesses {
 public:
  /// `sweep`: socket to it; `scratch`: for programs, or null. Throws
  /// std::runtime_error without shared memory.
  WatchedProcesses(const Limits& limits, int sweep, const ScratchFolder* scratch)
      : limits_(limits), sweep_(sweep), scratch_(scratch) {}

  /// `subject`: what exceeds a limit ("the cell"); `when`: added to how it ended. Ends this process
  /// if the sweep has ended. Throws std::runtime_error if no process can be created.
  ProcessEnd run(const std::string& subject, const std::string& when, const ProcessWork& work);

 private:
  const Limits& limits_;
  int sweep_;
  const ScratchFolder* scratch_;
  ResultArea area_;
};

}  // namespace loopbench::harness

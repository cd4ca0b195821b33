/// Processes that a worker forks for code that may fail: limits, output, and the end of all that
/// they started.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/base/result_area.hpp"
#include "harness/catalogue/scratch.hpp"
#include "harness/model/status.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench::harness {

/// What a process does and how reasons describe it.
struct WatchedWork {
  std::string subject;  ///< what exceeds a limit: "the cell"
  const Limits& limits;
  std::string when;                  ///< added to how it ended
  bool is_captured = true;           ///< its output is limited; otherwise it goes to standard error
  std::vector<int> kept;             ///< descriptors to keep open
  std::function<std::string()> run;  ///< in the new process; returns its result
};

/// How a process ended: with a result, or with the reason why it left none.
struct ProcessEnd {
  std::string_view result;  ///< valid until the next process
  Status status = Status::ok;
  std::string why;
  std::string signal;  ///< that ended it, for example "SIGSEGV"
};

/// Whether the other end of the socket is closed.
bool has_sweep_ended(int socket);

/// Forks one process after another; each starts as a copy of the worker, with nothing of earlier
/// ones.
class WatchedProcesses {
 public:
  /// `sweep`: socket to it; `scratch`: for programs, or null. Throws std::runtime_error without
  /// shared memory.
  WatchedProcesses(int sweep, const ScratchFolder* scratch);
  ~WatchedProcesses();
  WatchedProcesses(const WatchedProcesses&) = delete;
  WatchedProcesses& operator=(const WatchedProcesses&) = delete;

  /// Ends this process if the sweep has ended. Throws std::runtime_error if no process can be
  /// created.
  ProcessEnd run(const WatchedWork& work);

 private:
  /// In the new process.
  void prepare(const WatchedWork& work, int output) const;

  int sweep_;
  int null_;  ///< /dev/null
  const ScratchFolder* scratch_;
  ResultArea area_;
};

}  // namespace loopbench::harness

/// A worker process as the sweep uses it: jobs, answers and time.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/base/child_process.hpp"
#include "harness/run/active_clock.hpp"
#include "harness/run/worker.hpp"

namespace loopbench::harness {

/// A message of a worker.
struct Answer {
  Header::Kind kind = Header::Kind::result;
  std::string body;
};

class WorkerProcess {
 public:
  /// Forks. Only from a process without threads that is a subreaper. Throws std::runtime_error on
  /// failure.
  WorkerProcess(const WorkerContext& context, int core);
  ~WorkerProcess();  ///< kills it if it is running
  WorkerProcess(const WorkerProcess&) = delete;
  WorkerProcess& operator=(const WorkerProcess&) = delete;

  /// Does not block: a few jobs fit into the socket buffer. An error shows as the worker's end.
  void send(const Job& job) const;

  /// Reads what is there, a few megabytes at most.
  void receive();

  /// The first received answer that is complete.
  std::optional<Answer> next_answer();

  int socket() const { return socket_; }
  ChildProcess& child() { return *child_; }
  const ChildProcess& child() const { return *child_; }

 private:
  int run_child(const WorkerContext& context, int core, int socket) const;

  int socket_ = -1;
  std::string bytes_;  ///< received, not yet taken
  std::optional<ChildProcess> child_;
};

/// A worker and its unanswered jobs in order.
struct WorkerSlot {
  std::unique_ptr<WorkerProcess> process;
  std::deque<Job> jobs;
  std::optional<std::size_t> group;  ///< of its last cell, see CellQueue
  ActiveClock clock;                 ///< since its first job became the first
  bool is_stuck = false;             ///< killed because it did not answer
};

/// The highest core this process may use, since the first ones handle most interrupts.
int last_core();

/// Waits until a worker answers or ends, at most as long as the clocks of workers allow.
void wait_for_workers(const std::vector<WorkerSlot>& slots);

/// Kills a worker that does not end its cell: one that a cell stopped.
void end_if_stuck(WorkerSlot& slot, const Limits& limits);

/// What the end of a worker means for its first job.
Failure failure_of_worker(WorkerSlot& slot);

}  // namespace loopbench::harness

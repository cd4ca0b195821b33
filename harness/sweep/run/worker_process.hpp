/// A worker process as the sweep uses it: jobs, answers and time.
#pragma once

#include <linux/close_range.h>
#include <poll.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <deque>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "datasets/core/error.hpp"
#include "harness/sweep/process/child_process.hpp"
#include "harness/sweep/process/system_file.hpp"
#include "harness/sweep/run/watched_process.hpp"
#include "harness/sweep/run/worker.hpp"

namespace loopbench::harness {

/// What to do when the system refuses processes.
inline constexpr const char* kMoreProcesses =
    "; use fewer workers (--jobs), or raise the limit of processes (ulimit -u)";

/// A message of a worker.
struct Answer {
  Header::Kind kind = Header::Kind::result;
  std::string body;
};

class WorkerProcess {
 public:
  /// Forks. Only from a process without threads that is a subreaper. Throws InputError on failure.
  WorkerProcess(const WorkerContext& context, int core) {
    const auto error = [](const std::string& why) {
      return InputError("cannot create a worker process: " + why + kMoreProcesses);
    };
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
      throw error(std::string("socket pair: ") + std::strerror(errno));
    }
    socket_ = ends[0];
    std::fflush(nullptr);  // otherwise the worker would print buffered output again
    try {
      child_.emplace(ProcessGroup::shared, [&] { return run_child(context, core, ends[1]); });
    } catch (const std::runtime_error& reason) {
      close(ends[0]);
      close(ends[1]);
      throw error(reason.what());
    }
    close(ends[1]);
  }
  /// Kills it if it is running.
  ~WorkerProcess() {
    child_.reset();
    close(socket_);
  }
  WorkerProcess(const WorkerProcess&) = delete;
  WorkerProcess& operator=(const WorkerProcess&) = delete;

  /// Does not block: a few jobs fit into the socket buffer. An error shows as the worker's end.
  void send(const Job& job) const {
    [[maybe_unused]] const ssize_t sent = ::send(socket_, &job, sizeof job, MSG_NOSIGNAL);
  }

  /// Reads what is there, a few megabytes at most.
  void receive() {
    constexpr std::size_t kMost = std::size_t{4} << 20;  // [bytes], more than a socket holds
    char buffer[1 << 16];
    for (std::size_t count = 0; count < kMost;) {
      const ssize_t got = recv(socket_, buffer, sizeof buffer, MSG_DONTWAIT);
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) return;
      bytes_.append(buffer, static_cast<std::size_t>(got));
      count += static_cast<std::size_t>(got);
    }
  }

  /// The first received answer that is complete.
  std::optional<Answer> next_answer() {
    Header header;
    if (bytes_.size() < sizeof header) return std::nullopt;
    std::memcpy(&header, bytes_.data(), sizeof header);
    if (header.size > bytes_.size() - sizeof header) return std::nullopt;
    Answer out{header.kind, bytes_.substr(sizeof header, header.size)};
    bytes_.erase(0, sizeof header + header.size);
    return out;
  }

  int socket() const { return socket_; }
  ChildProcess& child() { return *child_; }
  const ChildProcess& child() const { return *child_; }

 private:
  int run_child(const WorkerContext& context, int core, int socket) const {
    // Close the sweep's files: the store, its lock and the other workers' sockets.
    const auto number = static_cast<unsigned>(socket);
    close_range(STDERR_FILENO + 1, number - 1, 0);
    close_range(number + 1, ~0u, 0);
    prctl(PR_SET_CHILD_SUBREAPER, 1);
    const rlimit no_core{0, 0};
    setrlimit(RLIMIT_CORE, &no_core);
    // If the system runs out of memory, it should kill the worker, not the sweep.
    write_system_file("/proc/self/oom_score_adj", "500");
    run_worker(context, socket, core);
    return 0;
  }

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

inline constexpr double kGrace =
    5.0;  // [s], for the worker to end loading and a cell at their limits

/// The highest core this process may use, since the first ones handle most interrupts.
inline int last_core() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof set, &set) != 0) return 0;
  int last = 0;
  for (int core = 0; core < CPU_SETSIZE; ++core) {
    if (CPU_ISSET(static_cast<std::size_t>(core), &set)) last = core;
  }
  return last;
}

/// Waits until a worker answers or ends, at most as long as the clocks of workers allow.
inline void wait_for_workers(const std::vector<WorkerSlot>& slots) {
  std::vector<pollfd> events;
  for (const WorkerSlot& slot : slots) {
    if (!slot.process || slot.jobs.empty()) continue;
    events.push_back({slot.process->socket(), POLLIN, 0});
    events.push_back({slot.process->child().descriptor(), POLLIN, 0});
  }
  // Also ended by an interrupt, which stops the sweep.
  poll(events.data(), events.size(), ActiveClock::kTick);
}

/// Kills a worker that does not end its cell: one that a cell stopped.
inline void end_if_stuck(WorkerSlot& slot, const Limits& limits) {
  const double seconds = slot.clock.seconds();
  if (slot.jobs.empty() || limits.seconds <= 0.0 || slot.is_stuck) return;
  if (seconds <= 2.0 * limits.seconds + kGrace) return;
  slot.is_stuck = true;
  slot.process->child().kill();
}

/// What the end of a worker means for its first job.
inline Failure failure_of_worker(WorkerSlot& slot) {
  const int status = slot.process->child().end();
  const Failure::Kind kind = !slot.jobs.empty() && slot.jobs.front().only_load
                                 ? Failure::Kind::loading
                                 : Failure::Kind::cell;
  if (slot.is_stuck) {
    return {kind,
            Status::timeout,
            "its worker process was stopped and did not end it at its time limit",
            "SIGKILL"};
  }
  const std::string signal = WIFSIGNALED(status) ? signal_name(WTERMSIG(status)) : "";
  return {kind, Status::crashed, "its worker process " + end_text(status), signal};
}

}  // namespace loopbench::harness

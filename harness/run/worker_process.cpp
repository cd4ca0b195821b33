#include "harness/run/worker_process.hpp"

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
#include <stdexcept>

#include "harness/base/system_file.hpp"

namespace loopbench::harness {
namespace {

constexpr double kGrace = 5.0;  // [s], for the worker to end loading and a cell at their limits

}  // namespace

WorkerProcess::WorkerProcess(const WorkerContext& context, int core) {
  const auto error = [](const std::string& why) {
    return std::runtime_error("cannot create a worker process: " + why);
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

WorkerProcess::~WorkerProcess() {
  child_.reset();
  close(socket_);
}

int WorkerProcess::run_child(const WorkerContext& context, int core, int socket) const {
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

void WorkerProcess::send(const Job& job) const {
  [[maybe_unused]] const ssize_t sent = ::send(socket_, &job, sizeof job, MSG_NOSIGNAL);
}

void WorkerProcess::receive() {
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

std::optional<Answer> WorkerProcess::next_answer() {
  Header header;
  if (bytes_.size() < sizeof header) return std::nullopt;
  std::memcpy(&header, bytes_.data(), sizeof header);
  if (header.size > bytes_.size() - sizeof header) return std::nullopt;
  Answer out{header.kind, bytes_.substr(sizeof header, header.size)};
  bytes_.erase(0, sizeof header + header.size);
  return out;
}

/// The highest core this process may use, since the first ones handle most interrupts.
int last_core() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof set, &set) != 0) return 0;
  int last = 0;
  for (int core = 0; core < CPU_SETSIZE; ++core) {
    if (CPU_ISSET(static_cast<std::size_t>(core), &set)) last = core;
  }
  return last;
}

void wait_for_workers(const std::vector<WorkerSlot>& slots) {
  std::vector<pollfd> events;
  for (const WorkerSlot& slot : slots) {
    if (!slot.process || slot.jobs.empty()) continue;
    events.push_back({slot.process->socket(), POLLIN, 0});
    events.push_back({slot.process->child().descriptor(), POLLIN, 0});
  }
  // Also ended by an interrupt, which stops the sweep.
  poll(events.data(), events.size(), ActiveClock::kTick);
}

void end_if_stuck(WorkerSlot& slot, const Limits& limits) {
  const double seconds = slot.clock.seconds();
  if (slot.jobs.empty() || limits.seconds <= 0.0 || slot.is_stuck) return;
  if (seconds <= 2.0 * limits.seconds + kGrace) return;
  slot.is_stuck = true;
  slot.process->child().kill();
}

Failure failure_of_worker(WorkerSlot& slot) {
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

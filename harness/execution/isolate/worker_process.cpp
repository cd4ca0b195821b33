#include "harness/execution/isolate/worker_process.hpp"

#include <fcntl.h>
#include <linux/close_range.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <stdexcept>

#include "harness/execution/isolate/process_tree.hpp"
#include "harness/execution/sandbox/system_file.hpp"

namespace loopbench::harness {
namespace {

std::runtime_error creation_error(const std::string& what) {
  return std::runtime_error("cannot create a worker process: " + what + ": " +
                            std::strerror(errno));
}

}  // namespace

WorkerProcess::WorkerProcess(const WorkerContext& context, int core) {
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
    release();
    throw creation_error("socket pair");
  }
  socket_ = ends[0];
  std::fflush(nullptr);  // otherwise the worker would print buffered output again
  process_ = fork_when_possible();
  if (process_ == 0) run_child(context, core, ends[1]);
  close(ends[1]);
  descriptor_ = process_ > 0 ? process_descriptor(process_) : -1;
  if (descriptor_ >= 0) return;
  const std::runtime_error error = creation_error(process_ > 0 ? "pidfd_open" : "fork");
  release();
  throw error;
}

WorkerProcess::~WorkerProcess() { release(); }

void WorkerProcess::release() {
  if (process_ > 0) {
    kill();
    end();
  }
  if (descriptor_ >= 0) close(descriptor_);
  if (socket_ >= 0) close(socket_);
}

void WorkerProcess::run_child(const WorkerContext& context, int core, int socket) {
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
  std::fflush(nullptr);
  _exit(0);  // without running the sweep's destructors
}

void WorkerProcess::send(const Job& job) {
  // Errors are ignored: the sweep notices that a worker has ended.
  [[maybe_unused]] const ssize_t sent = ::send(socket_, &job, sizeof job, MSG_NOSIGNAL);
}

void WorkerProcess::receive(std::string& bytes) {
  constexpr std::size_t kMost = std::size_t{4} << 20;  // [bytes], more than a socket holds
  char buffer[1 << 16];
  for (std::size_t count = 0; count < kMost;) {
    const ssize_t got = recv(socket_, buffer, sizeof buffer, MSG_DONTWAIT);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return;
    bytes.append(buffer, static_cast<std::size_t>(got));
    count += static_cast<std::size_t>(got);
  }
}

void WorkerProcess::kill() const {
  if (process_ > 0) ::kill(process_, SIGKILL);
}

bool WorkerProcess::has_ended() const {
  pollfd event{descriptor_, POLLIN, 0};
  return poll(&event, 1, 0) > 0;
}

WorkerProcess::End WorkerProcess::end() {
  int status = 0;
  while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  process_ = -1;
  if (WIFSIGNALED(status)) return {WTERMSIG(status), 0};
  return {0, WEXITSTATUS(status)};
}

}  // namespace loopbench::harness

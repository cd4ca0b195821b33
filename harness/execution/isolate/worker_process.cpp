#include "harness/execution/isolate/worker_process.hpp"

#include <fcntl.h>
#include <linux/close_range.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <new>
#include <stdexcept>

namespace loopbench::harness {
namespace {

std::runtime_error creation_error(const std::string& what) {
  return std::runtime_error("cannot create a worker process: " + what + ": " +
                            std::strerror(errno));
}

/// If the system runs out of memory, it should kill the worker, not the sweep.
void raise_oom_score() {
  const int file = open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC);
  if (file < 0) return;
  [[maybe_unused]] const ssize_t written = write(file, "500", 3);
  close(file);
}

}  // namespace

WorkerProcess::WorkerProcess(const WorkerContext& context, int pinned) {
  void* shared = mmap(
      nullptr, sizeof(SharedStatus), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (shared == MAP_FAILED) throw creation_error("shared memory");
  shared_status_ = new (shared) SharedStatus;
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
    munmap(shared_status_, sizeof(SharedStatus));
    throw creation_error("socket pair");
  }
  std::fflush(nullptr);  // otherwise the worker would print buffered output again
  const pid_t parent = getpid();
  process_ = fork();
  if (process_ == 0) run_child(context, pinned, ends[1], parent);
  close(ends[1]);
  socket_ = ends[0];
  if (process_ > 0) return;
  close(socket_);
  munmap(shared_status_, sizeof(SharedStatus));
  throw creation_error("fork");
}

WorkerProcess::~WorkerProcess() {
  if (process_ > 0) {
    kill();
    end();
  }
  close(socket_);
  munmap(shared_status_, sizeof(SharedStatus));
}

void WorkerProcess::run_child(const WorkerContext& context, int pinned, int socket, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(0);  // the parent has died in the meantime
  // The sweep handles signals to the process group; a worker that ended by one would look like a
  // crashed cell. Handlers, because programs that a method starts would inherit ignored signals.
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, [](int) {});
  // Close the sweep's files: the store, its lock and the other workers' sockets.
  constexpr int kSocket = 3;
  if (socket != kSocket) dup2(socket, kSocket);
  close_range(kSocket + 1, ~0u, 0);
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  raise_oom_score();
  run_worker(context, kSocket, *shared_status_, pinned);
  std::fflush(nullptr);
  _exit(0);  // without running the sweep's destructors
}

void WorkerProcess::send(const Job& job) {
  // Errors are ignored: receive() reports that a worker has ended.
  [[maybe_unused]] const ssize_t sent = ::send(socket_, &job, sizeof job, MSG_NOSIGNAL);
}

bool WorkerProcess::receive(std::string& bytes) {
  char buffer[1 << 16];
  for (;;) {
    const ssize_t got = recv(socket_, buffer, sizeof buffer, MSG_DONTWAIT);
    if (got > 0) {
      bytes.append(buffer, static_cast<std::size_t>(got));
    } else if (got < 0 && errno == EINTR) {
      continue;
    } else {
      return got < 0 && (errno == EAGAIN || errno == EWOULDBLOCK);
    }
  }
}

void WorkerProcess::kill() const {
  if (process_ > 0) ::kill(process_, SIGKILL);
}

WorkerProcess::End WorkerProcess::end() {
  int status = 0;
  while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  process_ = -1;
  if (WIFSIGNALED(status)) return {WTERMSIG(status), 0};
  return {0, WEXITSTATUS(status)};
}

std::int64_t WorkerProcess::resident_memory() const {
  std::ifstream in("/proc/" + std::to_string(process_) + "/statm");
  std::int64_t all = 0;
  std::int64_t resident = 0;  // [pages]
  return in >> all >> resident ? resident * sysconf(_SC_PAGESIZE) : 0;
}

}  // namespace loopbench::harness

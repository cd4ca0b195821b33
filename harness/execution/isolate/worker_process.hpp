/// A worker process as seen by the sweep: process, socket, shared status.
#pragma once

#include <sys/types.h>

#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "harness/execution/isolate/worker.hpp"

namespace loopbench::harness {

class WorkerProcess {
 public:
  /// Forks. Only from a process without threads. Throws std::runtime_error on failure.
  WorkerProcess(const WorkerContext& context, int pinned);
  ~WorkerProcess();  ///< kills it if it is running
  WorkerProcess(const WorkerProcess&) = delete;
  WorkerProcess& operator=(const WorkerProcess&) = delete;

  /// Does not block: a few jobs fit into the socket buffer. Errors are reported by receive().
  void send(const Job& job);

  /// Appends received bytes to `bytes`; false after the worker has ended and everything is read.
  bool receive(std::string& bytes);

  void kill() const;

  /// After receive() returned false: the signal that ended it, or 0 and its exit code.
  struct End {
    int signal = 0;
    int exit_code = 0;
  };
  End end();

  /// Resident size [bytes], 0 if unknown.
  std::int64_t resident_memory() const;

  const SharedStatus& shared_status() const { return *shared_status_; }
  int socket() const { return socket_; }

 private:
  [[noreturn]] void run_child(const WorkerContext& context, int pinned, int socket, pid_t parent);

  SharedStatus* shared_status_ = nullptr;  ///< in shared memory
  int socket_ = -1;
  pid_t process_ = -1;  ///< -1 after its end
};

}  // namespace loopbench::harness

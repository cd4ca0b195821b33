/// A worker process as seen by the sweep: process and socket.
#pragma once

#include <sys/types.h>

#include <string>

#include "harness/execution/isolate/worker.hpp"

namespace loopbench::harness {

class WorkerProcess {
 public:
  /// Forks. Only from a process without threads that is a subreaper. Throws std::runtime_error on
  /// failure.
  WorkerProcess(const WorkerContext& context, int core);
  ~WorkerProcess();  ///< kills it if it is running
  WorkerProcess(const WorkerProcess&) = delete;
  WorkerProcess& operator=(const WorkerProcess&) = delete;

  /// Does not block: a few jobs fit into the socket buffer. Errors are reported by receive().
  void send(const Job& job);

  /// Appends received bytes to `bytes`, a few megabytes at most.
  void receive(std::string& bytes);

  void kill() const;

  /// Whether the process has ended, as its descriptor tells: descendants may hold the socket.
  bool has_ended() const;

  /// After its end or kill(): the signal that ended it, or 0 and its exit code.
  struct End {
    int signal = 0;
    int exit_code = 0;
  };
  End end();

  int socket() const { return socket_; }
  int descriptor() const { return descriptor_; }  ///< of the process: readable when it has ended
  pid_t process() const { return process_; }      ///< -1 after end()

 private:
  [[noreturn]] void run_child(const WorkerContext& context, int core, int socket);
  void release();

  int socket_ = -1;
  int descriptor_ = -1;
  pid_t process_ = -1;
};

}  // namespace loopbench::harness

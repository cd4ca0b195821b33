/// A worker as the sweep sees it: a process, a socket, a board.
#pragma once

#include <sys/types.h>

#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "harness/execution/isolate/worker.hpp"

namespace loopbench {

class WorkerProcess {
 public:
  /// Forks. Only from a process without threads. Throws std::runtime_error when it cannot.
  WorkerProcess(const WorkerContext& context, int pinned);
  ~WorkerProcess();  ///< ends it, however busy
  WorkerProcess(const WorkerProcess&) = delete;
  WorkerProcess& operator=(const WorkerProcess&) = delete;

  /// Never waits: a few jobs fit the socket. Whether it still listens shows in receive().
  void send(const Job& job);

  /// Appends what has come to `bytes`; false once the worker has ended and all is read.
  bool receive(std::string& bytes);

  void kill() const;

  /// After receive() was false: the signal that ended it, or 0 and its exit code.
  struct End {
    int signal = 0;
    int exit_code = 0;
  };
  End end();

  /// Resident size [bytes], 0 when it cannot be told.
  std::int64_t resident_memory() const;

  const Board& board() const { return *board_; }
  int socket() const { return socket_; }

 private:
  [[noreturn]] void be_worker(const WorkerContext& context, int pinned, int socket, pid_t parent);

  Board* board_ = nullptr;  ///< in shared memory
  int socket_ = -1;
  pid_t process_ = -1;  ///< -1 once its end is known
};

}  // namespace loopbench

/// A child process in its own process group, as a shell starts one.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace loopbench::campaign {

class Child {
 public:
  /// Starts `words` with standard output and error in `output`. `file_limit`: largest file that it
  /// can write [bytes]; 0: any. Throws std::runtime_error.
  Child(const std::vector<std::string>& words,
        const std::filesystem::path& output,
        std::uint64_t file_limit = 0);
  /// Kills the group if it still runs.
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  pid_t id() const { return id_; }
  void signal(int number) const;        ///< to the process
  void signal_group(int number) const;  ///< to its group, as a terminal does

  /// Exit code, or 128 plus the signal that ended it; -1, and the group is killed, if it still runs
  /// after the time.
  int wait(std::chrono::milliseconds limit);

 private:
  pid_t id_ = -1;
  bool ended_ = false;
};

/// Makes this process the parent of all descendants whose parents end.
void adopt_orphans();

/// Waits until all descendants of this process have ended; kills those that still run after the
/// time and returns their command lines.
std::vector<std::string> left_processes(std::chrono::milliseconds limit);

/// Direct children of a process.
std::vector<pid_t> children_of(pid_t process);

}  // namespace loopbench::campaign

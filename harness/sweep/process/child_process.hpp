/// Child processes: copies of this process, and programs.
#pragma once

#include <sys/resource.h>
#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace loopbench::harness {

/// A program to start.
struct ProgramCall {
  std::vector<std::string> arguments;    ///< the program first; searched in PATH without a slash
  std::filesystem::path folder = ".";    ///< working directory; must exist
  std::vector<std::string> environment;  ///< "NAME=VALUE"; empty: that of this process
  int input = -1;                        ///< its standard input; -1: /dev/null
  int output = -1;                       ///< its standard output; -1: that of this process
  int errors = -1;                       ///< its standard error; -1: that of this process
};

enum class ProcessGroup {
  own,    ///< leads a process group of its own, which is killed with it
  shared  ///< gets the signals of the terminal as this process does
};

/// One child. Its destructor ends it, except in a process that was forked after the constructor.
class ChildProcess {
 public:
  /// Forks: the child calls `work` and exits with its result, without destructors of this program.
  /// With ProcessGroup::own it also ends when this thread does. A lack of processes (EAGAIN) is
  /// waited for. Throws std::runtime_error.
  ChildProcess(ProcessGroup group, const std::function<int()>& work);

  /// Starts a program with default signals and no other open files. Throws std::system_error if it
  /// cannot be started.
  ChildProcess(ProcessGroup group, const ProgramCall& call);

  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  pid_t id() const { return id_; }                ///< -1 after end()
  int descriptor() const { return descriptor_; }  ///< readable when it has ended

  /// Whether it has ended; waits for that at most `wait` [ms], -1: without limit.
  bool has_ended(int wait = 0) const;

  /// Kills it and its group.
  void kill() const;

  /// Kills what is left and returns the wait status, unchanged if it had ended; 0 after the first
  /// call. `usage` is set only in the process that started it.
  int end(rusage* usage = nullptr);

  /// Waits for its end and returns its exit code, or 128 + the signal.
  int exit_code();

 private:
  void open_descriptor();

  ProcessGroup group_;
  pid_t owner_;
  pid_t id_ = -1;
  int descriptor_ = -1;
};

/// For example "SIGSEGV".
std::string signal_name(int signal);

/// "exited with code 3", "was ended by SIGSEGV".
std::string end_text(int wait_status);

}  // namespace loopbench::harness

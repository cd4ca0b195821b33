/// An external program, started in a process group of its own. In a sweep, the worker ends what it
/// leaves behind and limits its time, memory and number of processes as those of any cell.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness/sweep/process/child_process.hpp"
#include "harness/sweep/process/sandbox.hpp"

namespace loopbench::harness {

struct ProgramStart {
  std::vector<std::string> arguments;  ///< the program first; searched in PATH without a slash
  std::filesystem::path folder;        ///< working directory; must exist
  std::vector<std::pair<std::string, std::string>> environment;  ///< variables to set
  const SandboxOptions* sandbox = nullptr;                       ///< null: none
  std::vector<std::filesystem::path> readable;                   ///< what the sandbox shows
  std::filesystem::path writable;  ///< the only folder that it can write into
  bool network = false;            ///< the sandbox leaves it the network of this machine
  bool serves = false;             ///< standard input and output are connected to this process
  bool shows_errors = false;       ///< its standard error is that of this process
};

struct ProgramEnd {
  int exit_code = -1;   ///< -1 unless it exited
  int signal = 0;       ///< signal that ended it, or 0
  int start_error = 0;  ///< errno if it could not be started
  /// Of the processes that it waited for, too; in a sandbox, cost as sampled every 10 ms.
  double cpu_seconds = 0.0;
  std::int64_t peak_memory = 0;  ///< largest resident size of one of its processes [bytes]
};

class RunningProgram {
 public:
  /// Starts the program. Throws std::runtime_error if no process can be created; a program that
  /// cannot be executed is reported by its ProgramEnd.
  explicit RunningProgram(const ProgramStart& start);
  /// Ends the program with its process group, except in a process that was forked after the
  /// constructor.
  ~RunningProgram();
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;

  /// Waits for its end. `output` receives the end of what it printed, and `tick` gets it several
  /// times a second. Also from a forked process, then without times and memory.
  ProgramEnd wait(std::string& output, const std::function<void(const std::string&)>& tick = {});

  /// Whether the program has ended, without waiting.
  bool has_ended() const;

  pid_t process() const { return process_ ? process_->id() : -1; }
  int input() const { return input_; }    ///< socket to its standard input, -1 unless it serves
  int output() const { return output_; }  ///< its standard output; with its errors unless it serves
  int errors() const { return errors_; }  ///< its standard error, -1 unless it serves
  int descriptor() const { return process_ ? process_->descriptor() : -1; }  ///< see ChildProcess

 private:
  std::optional<ChildProcess> process_;  ///< none if it could not be started
  int start_error_ = 0;
  bool is_sandboxed_ = false;
  int input_ = -1;
  int output_ = -1;
  int errors_ = -1;
};

/// Appends what can be read from `file` now to `text`, which keeps its last kKeptOutput bytes;
/// false at the end of the file.
bool read_available(int file, std::string& text);
inline constexpr std::size_t kKeptOutput = 2000;

/// "exited with code 3", "was ended by SIGSEGV", "cannot be started: No such file or directory".
std::string text(const ProgramEnd& end);

}  // namespace loopbench::harness

/// An external program and all processes that it starts, under one supervisor.
///
/// The supervisor is a small process between this one and the program. Descendants whose parent
/// ends become its children, so it can end all of them, also those that left the program's process
/// group. It does so when the program ends, when the memory limit is exceeded, and when this
/// process ends for any reason, because then its control pipe is closed.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "harness/execution/sandbox/sandbox.hpp"

namespace loopbench::harness {

struct ProgramStart {
  std::vector<std::string> arguments;  ///< the program first; searched in PATH without a slash
  std::filesystem::path folder;        ///< working directory; must exist
  std::vector<std::pair<std::string, std::string>> environment;  ///< variables to set
  std::filesystem::path scratch;            ///< folder that is removed with the tree; empty: none
  std::int64_t memory = 0;                  ///< limit of the tree's resident size [bytes]; 0: none
  const SandboxOptions* sandbox = nullptr;  ///< null: none
  std::vector<std::filesystem::path> readable;  ///< what the sandbox shows
  std::filesystem::path writable;               ///< the only folder that it can write into
  bool serves = false;  ///< standard input and output are connected to this process
};

/// Limit of a tree, apart from threads.
inline constexpr int kMostProgramProcesses = 64;

/// Sent by the supervisor as raw memory.
struct ProgramEnd {
  int exit_code = -1;               ///< -1 unless it exited
  int signal = 0;                   ///< signal that ended it, or 0
  int start_error = 0;              ///< errno if it could not be started
  std::int64_t over_memory = 0;     ///< resident size of the tree that exceeded the limit [bytes]
  std::int64_t over_processes = 0;  ///< processes of the tree that exceeded the limit
  std::int64_t left_behind = 0;     ///< processes that outlived it and were killed; 0 in a sandbox
  double cpu_seconds = 0.0;         ///< of the tree
  std::int64_t peak_memory = 0;     ///< largest resident size of one of its processes [bytes]
};

class ProcessTree {
 public:
  /// Starts the program. Throws std::runtime_error if no process can be created; a program that
  /// cannot be executed is reported by its ProgramEnd.
  explicit ProcessTree(const ProgramStart& start);
  /// Ends the tree, removes the scratch folder and waits for both. Does nothing in a process that
  /// was forked after the constructor.
  ~ProcessTree();
  ProcessTree(const ProcessTree&) = delete;
  ProcessTree& operator=(const ProcessTree&) = delete;

  /// Waits for the end of the tree. `output` receives the end of what it printed.
  ProgramEnd wait(std::string& output);

  /// Whether the program has ended, without waiting.
  bool has_ended() const;

  pid_t supervisor() const { return supervisor_; }
  int input() const { return input_; }    ///< socket to its standard input, -1 unless it serves
  int output() const { return output_; }  ///< its standard output; with its errors unless it serves
  int status() const { return status_; }  ///< receives the ProgramEnd
  int errors() const { return errors_; }  ///< its standard error, -1 unless it serves

 private:
  pid_t owner_ = -1;
  pid_t supervisor_ = -1;
  int control_ = -1;  ///< closed: the supervisor ends the tree
  int status_ = -1;   ///< ProgramEnd
  int input_ = -1;
  int output_ = -1;
  int errors_ = -1;
};

/// Appends what can be read from `file` now to `text`, which keeps its last kKeptOutput bytes;
/// false at the end of the file.
bool read_available(int file, std::string& text);
inline constexpr std::size_t kKeptOutput = 2000;

/// "exited with code 3", "was ended by SIGSEGV", "started more than 64 processes", "cannot be
/// started: No such file or directory".
std::string text(const ProgramEnd& end);

}  // namespace loopbench::harness

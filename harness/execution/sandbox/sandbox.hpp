/// Restricts what a method can reach on the machine, with what the system offers. Results do not
/// depend on it.
///
/// Three parts, each used if the system has it:
/// - a PID namespace for each worker: nothing outside can be signalled, and its end ends all of it;
///   with it, an IPC namespace, which removes the shared memory of datasets;
/// - Landlock: files can be read except `unreachable` and results of other sweeps beside one of
///   these paths, and written only in `writable`; no TCP;
/// - seccomp: no sockets, except local ones for programs; no ptrace, no access to the memory of
///   other processes, no io_uring, no mounts, no new namespaces, no System V IPC and POSIX message
///   queues, no changes of the priority and cores of the worker, nor, except by programs, of modes,
///   owners and times of files; capabilities are dropped, and core files and the process's memory
///   in /proc, which may hold the reference, are switched off until it executes a program.
/// Programs that a method starts inherit the restrictions. A method may start programs and read
/// shared libraries and data anywhere else, so a method that runs an external program only needs a
/// folder of its own in `writable`.
///
/// Not protected: the memory of the method's own process, which is a copy of the worker's and
/// contains the reference that the cell is evaluated against; other names (hard links) of
/// unreachable files; modes, owners and times of the user's files against programs.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

#include "harness/execution/sandbox/control_group.hpp"
#include "harness/execution/sandbox/seccomp.hpp"

namespace loopbench::harness {

struct SandboxOptions {
  bool enabled = true;
  bool pid_namespace = true;                       ///< only if enabled
  std::vector<std::filesystem::path> unreachable;  ///< results, references; may not exist
  std::vector<std::filesystem::path> writable;     ///< folders, apart from /dev/null
  const ControlGroups* groups = nullptr;           ///< for workers; null: none
};

/// The restrictions of one worker's cells, prepared before the cells are forked.
class Sandbox {
 public:
  /// `guarded`: processes, and groups as negative numbers, that must be neither signalled nor
  /// slowed down.
  Sandbox(const SandboxOptions& options, const std::vector<pid_t>& guarded);
  ~Sandbox();
  Sandbox(const Sandbox&) = delete;
  Sandbox& operator=(const Sandbox&) = delete;

  /// Restricts the calling thread and all its later threads and processes for ever.
  void enter(Privileges privileges = Privileges::of_programs) const;

 private:
  bool enabled_;
  int landlock_ = -1;  ///< rule set; -1: not available
  std::vector<sock_filter> for_methods_;
  std::vector<sock_filter> for_programs_;
};

/// Moves the later children of this process to a new PID namespace, whose init is the first of
/// them, and if possible to a new IPC namespace. False if the first is not permitted.
bool enter_pid_namespace();

/// Which parts the system has, for example "PID namespace on, Landlock on, seccomp off, cgroup
/// v2 kill, memory, pids". Creates a short-lived process.
std::string sandbox_summary(const SandboxOptions& options);

}  // namespace loopbench::harness

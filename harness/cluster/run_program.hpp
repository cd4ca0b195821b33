/// Runs programs of the cluster (sbatch, squeue, ...) without a shell.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace loopbench::harness {

struct ProgramResult {
  int exit_code = 0;  ///< 127: it cannot be started
  std::string out;    ///< its standard output
};

/// Runs a program found in PATH in the folder `where` and waits for it. Standard error is that of
/// this process, or discarded with `quiet`.
ProgramResult run_program(const std::vector<std::string>& words,
                          const std::filesystem::path& where,
                          bool quiet = false);

/// Starts a program in a session of its own, which continues after this process has ended. Its
/// output is appended to the file `log`. Throws InputError if the process cannot be created.
pid_t start_program(const std::vector<std::string>& words,
                    const std::filesystem::path& where,
                    const std::filesystem::path& log);

/// Start of a process in the clock ticks of the system, which tells apart processes that have the
/// same number one after the other; empty if there is none.
std::string start_of_process(pid_t process);

}  // namespace loopbench::harness

/// A private world for each external program, by bubblewrap. Results do not depend on it.
///
/// A program sees the file system read-only, with folders of data, results and references mounted
/// empty, except what it was given, its own folder and its folder for temporary files. Within
/// these, hidden files cannot be opened. /tmp is its own, the other folders for temporary files are
/// empty, so it sees nothing of other cells. It has devices, processes, IPC and keys of its own, so
/// nothing else can be signalled or left for others, and all of it ends with it; and a network of
/// its own, without any other machine, unless its config says `network: true`.
///
/// What is hidden is set by `run`, sandbox_of_sweep() in commands/run/plan.cpp, and for a dataset
/// that is a program also by sandbox_of_sequence() in sweep/catalogue/command_dataset.cpp. Programs
/// are started by RunningProgram (program.hpp).
///
/// Not protected: hidden files under other names (hard links, copies). Methods in C++ are not
/// restricted: their process contains the reference that the cell is evaluated against.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/sweep/process/bubblewrap.hpp"

namespace loopbench::harness {

struct SandboxOptions {
  bool enabled = true;
  std::vector<std::filesystem::path> hidden;  ///< files and folders; may not exist
};

/// A program to be restricted.
struct SandboxedProgram {
  std::vector<std::string> arguments;
  std::filesystem::path folder;                 ///< working directory; readable
  std::vector<std::filesystem::path> readable;  ///< what it was given, apart from its arguments
  std::filesystem::path writable;  ///< folder for temporary files, with its /tmp; may be empty
  bool network = false;            ///< that of this machine instead of its own
};

/// What programs can reach here although they should not; "" if there is nothing. `options`: those
/// of the sweep.
std::string missing_protection(const SandboxOptions& options);

/// The command line that runs the program under bubblewrap. Existing files in its command line are
/// readable unless they are hidden themselves, with their folders unless these are hidden; of the
/// program itself, its folder always. What is hidden is so at other mount points, too.
/// Creates a folder in `writable` for its /tmp.
std::vector<std::string> sandboxed_arguments(const SandboxOptions& options,
                                             const SandboxedProgram& program);

/// Restrictions on the programs of configs that this process and its forked children start.
SandboxOptions& program_sandbox();

/// Whether programs are restricted here; results of unrestricted ones are kept under other keys.
bool is_sandboxed();

/// "; the sandbox hides A, B from it" for reasons of failures; "" if nothing is hidden.
std::string hidden_note(const SandboxOptions& options);

}  // namespace loopbench::harness

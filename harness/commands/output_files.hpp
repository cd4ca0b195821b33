/// The rule for files that commands write: none of them loses anything that the user wants to keep.
///
/// A command does not write onto a file that it reads, nor twice onto one file, nor onto a store, a
/// config or a baseline, unless its purpose is to update that. Another existing file is replaced if
/// its content is of the kind that the option writes (file_kinds.hpp), otherwise only with --force.
/// Pipes and devices are no files. Options state what they read and write where they are declared;
/// main() checks them all before a command runs.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "harness/commands/file_kinds.hpp"

namespace loopbench::harness {

struct OutputFile {
  std::string option;          ///< that names it: "--report"
  std::filesystem::path file;  ///< empty or "-": none
  FileKind kind = FileKind::printed;
  bool replaces_links = false;  ///< instead of following them: the program chooses the name
};

/// Declares that the values of an option name files that the command reads, also after "=".
CLI::Option* reads(CLI::App& command, CLI::Option* option);

/// Declares that an option names a file that the command writes, and adds --force to the command. A
/// folder is no file: the command calls require_writable() with the files in it.
CLI::Option* writes(CLI::App& command, CLI::Option* option, FileKind kind);

/// Declares that an option names a file that the command updates if `flag` is given, or else reads.
CLI::Option* updates(CLI::App& command,
                     CLI::Option* option,
                     FileKind kind,
                     const CLI::Option* flag);

/// Removes an option, and what was declared of its files.
void remove_option(CLI::App& command, const std::string& name);

/// Adds --force to a command that computes the names of its files.
void declare_force(CLI::App& command);

/// Throws InputError if the command, whose line has been parsed, would break the rule. Further
/// checks are for this command.
void check_declared_files(const CLI::App& command);

/// The same for files whose names the command has computed; call before any of them is written.
void require_writable(const std::vector<OutputFile>& outputs);

}  // namespace loopbench::harness

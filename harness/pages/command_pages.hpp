/// Shell completions, from the same texts as `--help`.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace loopbench::harness {

struct CommandOption {
  std::vector<std::string> names;  ///< with hyphens, shortest first; or one name of an argument
  bool is_argument = false;        ///< positional
  bool is_required = false;
  std::string value;                 ///< placeholder of its value: FILE; empty for a flag
  std::vector<std::string> choices;  ///< accepted words, if the value is one of a few
  std::string help;
  std::string usual;  ///< default value as text; may be empty
};

struct CommandText {
  std::string name;  ///< empty: the program; "traj crop": a subcommand of another command
  std::string summary;
  std::vector<CommandOption> options;
  std::string footer;  ///< examples and further notes
};

/// The program first, then its commands, each followed by its subcommands.
using CommandTexts = std::vector<CommandText>;

/// Completions for commands, options, their choices and files.
std::string bash_completion(const CommandTexts& all);
std::string zsh_completion(const CommandTexts& all);
std::string fish_completion(const CommandTexts& all);

/// The completions by file name: loopbench.bash, _loopbench, loopbench.fish; and `commands`, a line
/// "NAME<tab>SUMMARY" for each manual page.
std::map<std::string, std::string> command_pages(const CommandTexts& all);

}  // namespace loopbench::harness

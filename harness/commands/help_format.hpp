/// Help texts: their layout, what they say about options, examples and exit codes.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace CLI {
class App;
class FormatterBase;
class Option;
}  // namespace CLI

namespace loopbench::harness {

/// The group of the options that --help prints of a command that has one; --help-all prints all.
inline constexpr const char* kDailyGroup = "Daily use";

/// Moves these options to kDailyGroup, and adds --help-all.
void declare_daily(CLI::App& command, const std::vector<std::string>& names);

/// Fits the width of the terminal, at most 100 columns; unlimited in pipes and files. Commands
/// added after it is set use it, too.
std::shared_ptr<CLI::FormatterBase> help_formatter();

/// With hyphens, short ones first; or the name of a positional argument.
std::vector<std::string> names_of(const CLI::Option& option);

/// Whether a value follows its name.
bool has_value(const CLI::Option& option);

/// The accepted words, if the value is one of a few.
std::vector<std::string> choices_of(const CLI::Option& option);

/// The subcommands, without hidden ones.
std::vector<const CLI::App*> commands_of(const CLI::App& app);

/// `loopbench help [COMMAND]`. Throws InputError with the nearest name for an unknown command.
void add_help(CLI::App& app, int& exit_code);

/// Adds examples and exit codes to the help of the program and of each command. Call it after all
/// commands are added.
void add_footers(CLI::App& app);

}  // namespace loopbench::harness

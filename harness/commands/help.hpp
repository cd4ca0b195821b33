/// Help texts beyond those that CLI11 derives from options.
#pragma once

#include <vector>

namespace CLI {
class App;
}

namespace loopbench::harness {

/// The subcommands, without hidden ones.
std::vector<const CLI::App*> commands_of(const CLI::App& app);

/// `loopbench help [COMMAND]`. Throws InputError with the nearest name for an unknown command.
void add_help(CLI::App& app, int& exit_code);

/// Adds examples and exit codes to the help of the program and of each command. Call it after all
/// commands are added.
void add_footers(CLI::App& app);

}  // namespace loopbench::harness

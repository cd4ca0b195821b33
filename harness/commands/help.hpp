/// Help texts beyond those that CLI11 derives from options.
#pragma once

namespace CLI {
class App;
}

namespace loopbench::harness {

/// `loopbench help [COMMAND]`. Throws InputError with the nearest name for an unknown command.
void add_help(CLI::App& app, int& exit_code);

/// Adds examples and exit codes to the help of the program and of each command. Call it after all
/// commands are added.
void add_footers(CLI::App& app);

/// `loopbench pages DIR`, hidden: writes manual pages and shell completions of all commands.
void add_pages(CLI::App& app, int& exit_code);

}  // namespace loopbench::harness

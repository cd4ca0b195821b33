/// The subcommand `export`, see commands.hpp.
#pragma once

namespace CLI {
class App;
}

namespace loopbench::harness {

void add_export(CLI::App& app, int& exit_code);

}  // namespace loopbench::harness

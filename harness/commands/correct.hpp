/// The subcommand `correct`, see commands.hpp.
#pragma once

namespace CLI {
class App;
}

namespace loopbench::harness {

void add_correct(CLI::App& app, int& exit_code);

}  // namespace loopbench::harness

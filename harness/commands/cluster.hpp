/// The subcommands `submit`, `watch` and `cancel`, see commands.hpp.
#pragma once

#include "harness/provenance/collect_provenance.hpp"

namespace CLI {
class App;
}

namespace loopbench::harness {

void add_submit(CLI::App& app, int& exit_code, const Source& source);
void add_watch(CLI::App& app, int& exit_code);
void add_cancel(CLI::App& app, int& exit_code);

}  // namespace loopbench::harness

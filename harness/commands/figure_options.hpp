/// Options of figures that `plot`, `traj plot` and `eval --plot` share.
#pragma once

#include <string>

#include "harness/report/draw.hpp"

namespace CLI {
class App;
}

namespace loopbench::harness {

/// `needs`: option without which those of the files have no effect; empty: none.
void declare_figure_options(CLI::App& command, FigureOptions& options, const std::string& needs);

}  // namespace loopbench::harness

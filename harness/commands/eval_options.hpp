#pragma once

#include "harness/eval/arguments.hpp"

namespace CLI {
class App;
}

namespace loopbench::harness {

/// Declares the options; values are checked later, by the functions of eval/arguments.hpp.
void declare(CLI::App& command, EvalArguments& arguments);

/// Declares --downsample and --motion_filter, of `eval` and `traj convert`.
void declare_pose_filters(CLI::App& command,
                          std::optional<std::size_t>& downsample,
                          std::vector<double>& motion_filter);

}  // namespace loopbench::harness

#pragma once

#include "harness/commands/eval/arguments.hpp"

namespace CLI {
class App;
}

namespace loopbench::harness {

/// Declares the options; values are checked later, by the functions of eval/arguments.hpp.
void declare(CLI::App& command, EvalArguments& arguments);
}  // namespace loopbench::harness

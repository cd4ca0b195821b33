/// The program: its commands, and what it prints about errors.
#pragma once

#include "harness/sweep/run/source.hpp"

namespace loopbench::harness {

/// Runs the command of the arguments of main(); returns the exit code. Throws only without memory.
int run_program(int argc, char** argv, const Source& source);

}  // namespace loopbench::harness

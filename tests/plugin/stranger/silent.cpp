// A shared object without a LOOPBENCH_PLUGIN line.
#include "harness/plugin/plugin.hpp"

int answer() { return 42; }

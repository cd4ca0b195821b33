// A shared object without a LOOPBENCH_PLUGIN line.
#include "harness/sweep/catalogue/plugin.hpp"

int answer() { return 42; }

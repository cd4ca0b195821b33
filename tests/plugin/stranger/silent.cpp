// A shared object without a LOOPBENCH_PLUGIN line.
#include "harness/catalogue/plugin.hpp"

int answer() { return 42; }

// A shared object without a LOOPBENCH_PLUGIN line.
#include "methods/plugin.hpp"

int answer() { return 42; }

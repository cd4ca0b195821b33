// A shared object that forgot its LOOPBENCH_PLUGIN line.
#include "methods/plugin.hpp"

int answer() { return 42; }

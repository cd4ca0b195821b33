/// Everything that a plugin needs: methods, datasets and metrics, and LOOPBENCH_PLUGIN(...).
#pragma once

#include "harness/sweep/catalogue/plugin.hpp"

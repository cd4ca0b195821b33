/// Curves of angles.
#pragma once

#include "harness/plot/gnuplot.hpp"

namespace loopbench::harness {

/// Breaks the lines of a panel of angles [deg] between -180 and 180. O(points).
void break_at_wraps(PlotPanel& panel);

}  // namespace loopbench::harness

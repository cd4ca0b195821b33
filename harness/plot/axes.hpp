/// Ranges, tics and margins of a panel as gnuplot commands.
#pragma once

#include <string>

#include "harness/plot/gnuplot.hpp"

namespace loopbench::harness {

/// A panel's share of its page; from the lower left corner [in].
struct PanelBox {
  double left, bottom, width, height;
  double page_width, page_height;
};

/// Ranges without margins: gnuplot chooses, except for empty ranges, which it warns about.
std::string ranges(const PlotPanel& panel);

/// Margins around the axes with room for the title, the labels and the numbers at the axes, and the
/// ranges. All panels of the same size have axes of the same size; axes of the same scale fill
/// theirs: the shorter range is extended. `font` [pt].
std::string framed(const PlotPanel& panel, const PanelBox& box, double font);

}  // namespace loopbench::harness

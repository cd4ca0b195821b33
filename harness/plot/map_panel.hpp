/// Panels that show positions along two or three axes.
#pragma once

#include <array>

#include "harness/plot/gnuplot.hpp"

namespace loopbench::harness {

inline constexpr std::array kAxisLabels{"x [m]", "y [m]", "z [m]"};

/// Panel of the plane with axes `a` and `b` (0: x, 1: y, 2: z), or of space if they are equal.
inline PlotPanel empty_map(int a, int b) {
  PlotPanel out;
  out.spatial = a == b;
  if (!out.spatial) {
    out.x_label = kAxisLabels[static_cast<std::size_t>(a)];
    out.y_label = kAxisLabels[static_cast<std::size_t>(b)];
  }
  return out;
}

/// A position [m] as a point of empty_map(a, b).
inline Vector3 on_map(const Vector3& position, int a, int b) {
  return a == b ? position : Vector3(position[a], position[b], 0.0);
}

}  // namespace loopbench::harness

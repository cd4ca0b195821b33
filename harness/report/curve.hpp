/// Curves of figures, and their colours and dashes, the same in every figure.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "datasets/core/trajectory.hpp"

namespace loopbench::harness {

struct CurveStyle {
  const char* color;
  int dash;  ///< 1: solid, 2 to 5: dashed
};

/// Style of the curve with this index, of a method among all methods of a sweep or of a file among
/// all files of a command. The colours are those of python/loopbench/panels.py; each has a dash,
/// too, and 40 curves differ.
inline CurveStyle curve_style(std::size_t index) {
  constexpr std::array kColors{
      "#cc4c02", "#0068b0", "#2aa59a", "#7d1d6f", "#efb400", "#7fb8ec", "#5c3a14", "#f2a0c0"};
  return {kColors[index % kColors.size()], 1 + static_cast<int>(index % 5)};
}

/// A trajectory or its errors: columns of equal length, see harness/python/loopbench/draw.py.
struct DrawnCurve {
  std::string name;
  std::size_t style = 0;         ///< index of its colour and dash
  int dash = 0;                  ///< 1 to 5; 0: that of the style
  std::optional<double> rmse{};  ///< of the position error [m]; none: not stated in the legend
  std::map<std::string, std::vector<double>> columns;
};

/// DrawnCurve "reference" without columns; this name determines its style.
inline DrawnCurve reference_curve() { return {.name = "reference"}; }

/// Adds the columns time (stamps minus `origin` [s]), x, y, z [m], roll, pitch and yaw [deg].
void add_poses(DrawnCurve& curve, const Trajectory& poses, double origin);

/// Keeps about `most` evenly chosen rows and, between two of them, the least and the greatest value
/// of each column of `peaks`, so that no peak is lost; always the first and the last row. O(rows).
void thin(DrawnCurve& curve, std::size_t most, const std::vector<std::string>& peaks = {});

}  // namespace loopbench::harness

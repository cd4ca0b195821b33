/// Curves of figures.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "datasets/core/trajectory.hpp"

namespace loopbench::harness {

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

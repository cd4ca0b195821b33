/// Curves of figures.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "datasets/core/trajectory.hpp"
#include "harness/report/style.hpp"

namespace loopbench::harness {

/// A trajectory or its errors: columns of equal length, see harness/python/loopbench/draw.py.
struct DrawnCurve {
  std::string name;
  CurveStyle style = curve_style(0);
  std::map<std::string, std::vector<double>> columns;
};

inline constexpr CurveStyle kReferenceStyle{kReferenceColor, 1};

/// DrawnCurve "reference" without columns.
inline DrawnCurve reference_curve() { return {"reference", kReferenceStyle, {}}; }

/// Adds the columns time (stamps minus `origin` [s]), x, y, z [m], roll, pitch and yaw [deg].
void add_poses(DrawnCurve& curve, const Trajectory& poses, double origin);

/// Keeps about `most` evenly chosen rows and, between two of them, the least and the greatest value
/// of each column of `peaks`, so that no peak is lost; always the first and the last row. O(rows).
void thin(DrawnCurve& curve, std::size_t most, const std::vector<std::string>& peaks = {});

}  // namespace loopbench::harness

/// Curves of figures, and their colours and dashes, the same in every figure.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "datasets/core/trajectory.hpp"
#include "metrics/numerics/angle.hpp"
#include "metrics/numerics/euler.hpp"

namespace loopbench::harness {

struct CurveStyle {
  const char* color;
  int dash;  ///< 1: solid, 2 to 5: dashed
};

/// Those of python/loopbench/panels.py.
inline constexpr std::array kCurveColors{
    "#cc4c02", "#0068b0", "#2aa59a", "#7d1d6f", "#efb400", "#7fb8ec", "#5c3a14", "#f2a0c0"};

/// Style of the curve with this index, of a method among all methods of a sweep or of a file among
/// all files of a command. Each colour has a dash, too, and 40 curves differ.
inline CurveStyle curve_style(std::size_t index) {
  return {kCurveColors[index % kCurveColors.size()], 1 + static_cast<int>(index % 5)};
}

/// A trajectory or its errors: columns of equal length, see harness/python/loopbench/draw.py.
struct DrawnCurve {
  std::string name;
  std::size_t style = 0;         ///< index of its colour and dash
  int dash = 0;                  ///< 1 to 5; 0: that of the style
  std::optional<double> rmse{};  ///< of the position error [m]; none: not stated in the legend
  std::map<std::string, std::vector<double>> columns;
  std::vector<std::string> peaks = {};  ///< columns whose extremes stay if rows are left out
  bool is_thin = false;                 ///< rows were left out, or none had to be
};

/// DrawnCurve "reference" without columns; this name determines its style.
inline DrawnCurve reference_curve() { return {.name = "reference"}; }

/// Adds x, y, z [m].
inline void add_position(DrawnCurve& curve, const Vector3& position) {
  curve.columns["x"].push_back(position.x());
  curve.columns["y"].push_back(position.y());
  curve.columns["z"].push_back(position.z());
}

/// Adds the columns time (stamps minus `origin` [s]), x, y, z [m], roll, pitch and yaw [deg].
inline void add_poses(DrawnCurve& curve, const Trajectory& poses, double origin) {
  auto& columns = curve.columns;
  for (const StampedPose& pose : poses) {
    columns["time"].push_back(pose.stamp - origin);
    add_position(curve, pose.world_from_body.translation);
    if (!has_rotation(pose.world_from_body)) continue;
    const metrics::Euler angles = metrics::euler(pose.world_from_body.rotation);
    columns["roll"].push_back(metrics::kDegrees * angles.roll);
    columns["pitch"].push_back(metrics::kDegrees * angles.pitch);
    columns["yaw"].push_back(metrics::kDegrees * angles.yaw);
  }
}

/// Evenly spaced rows of a thinned curve; more are kept where it needs them.
inline constexpr std::size_t kMostRows = 1000;

/// Keeps kMostRows evenly spaced rows; between two of them the least and the greatest value of x,
/// y, z and each column of `peaks`, so that no peak is lost; and as many others as it takes that no
/// position is farther than a thousandth of the largest extent from the drawn curve. Curves that
/// are thin already stay as they are. O(rows log rows).
void thin(DrawnCurve& curve, const std::vector<std::string>& peaks = {});

}  // namespace loopbench::harness

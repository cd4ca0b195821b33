/// Curves of figures, and their colours and dashes, the same in every figure.
#pragma once

#include <algorithm>
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
};

/// DrawnCurve "reference" without columns; this name determines its style.
inline DrawnCurve reference_curve() { return {.name = "reference"}; }

/// Ascending, without duplicates.
inline std::vector<std::size_t> kept_rows(const DrawnCurve& curve,
                                          std::size_t rows,
                                          std::size_t step,
                                          const std::vector<std::string>& peaks) {
  std::vector<std::size_t> out;
  for (std::size_t first = 0; first < rows; first += step) {
    out.push_back(first);
    for (const std::string& name : peaks) {
      const std::vector<double>& values = curve.columns.at(name);
      const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first);
      const auto end = values.begin() + static_cast<std::ptrdiff_t>(std::min(first + step, rows));
      const auto [low, high] = std::minmax_element(begin, end);
      out.push_back(static_cast<std::size_t>(low - values.begin()));
      out.push_back(static_cast<std::size_t>(high - values.begin()));
    }
  }
  out.push_back(rows - 1);
  std::ranges::sort(out);
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

/// Adds the columns time (stamps minus `origin` [s]), x, y, z [m], roll, pitch and yaw [deg].
inline void add_poses(DrawnCurve& curve, const Trajectory& poses, double origin) {
  auto& columns = curve.columns;
  for (const StampedPose& pose : poses) {
    const Vector3& position = pose.world_from_body.translation;
    columns["time"].push_back(pose.stamp - origin);
    columns["x"].push_back(position.x());
    columns["y"].push_back(position.y());
    columns["z"].push_back(position.z());
    if (!has_rotation(pose.world_from_body)) continue;
    const metrics::Euler angles = metrics::euler(pose.world_from_body.rotation);
    columns["roll"].push_back(metrics::kDegrees * angles.roll);
    columns["pitch"].push_back(metrics::kDegrees * angles.pitch);
    columns["yaw"].push_back(metrics::kDegrees * angles.yaw);
  }
}

/// Keeps about `most` evenly chosen rows and, between two of them, the least and the greatest value
/// of each column of `peaks`, so that no peak is lost; always the first and the last row. O(rows).
inline void thin(DrawnCurve& curve, std::size_t most, const std::vector<std::string>& peaks = {}) {
  const std::size_t rows = curve.columns.empty() ? 0 : curve.columns.begin()->second.size();
  if (rows <= most) return;
  const std::vector<std::size_t> kept = kept_rows(curve, rows, (rows + most - 1) / most, peaks);
  for (auto& [name, values] : curve.columns) {
    std::vector<double> fewer;
    fewer.reserve(kept.size());
    for (const std::size_t i : kept) fewer.push_back(values[i]);
    values = std::move(fewer);
  }
}

}  // namespace loopbench::harness

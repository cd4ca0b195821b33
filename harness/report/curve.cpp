#include "harness/report/curve.hpp"

#include <algorithm>

#include "metrics/numerics/angle.hpp"
#include "metrics/numerics/euler.hpp"

namespace loopbench::harness {
namespace {

/// Ascending, without duplicates.
std::vector<std::size_t> kept_rows(const DrawnCurve& curve,
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

}  // namespace

void add_poses(DrawnCurve& curve, const Trajectory& poses, double origin) {
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

void thin(DrawnCurve& curve, std::size_t most, const std::vector<std::string>& peaks) {
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

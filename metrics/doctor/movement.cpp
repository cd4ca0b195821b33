#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "metrics/doctor/common_motion.hpp"
#include "metrics/doctor/graph_checks.hpp"
#include "metrics/numerics/angle.hpp"

namespace loopbench::metrics {

std::optional<InputFinding> check_movement(const Problem& problem, const Trajectory& corrected) {
  constexpr double kShare = 0.01, kLeastGap = 1e-3;  // [m]
  constexpr double kLeastAngle = 0.01 / kDegrees;
  const Trajectory& before = problem.keyframes;
  if (problem.closures.empty() || corrected.size() != before.size()) return std::nullopt;
  std::vector<double> gaps, angles;
  for (const Edge& edge : problem.closures) {
    const Pose difference =
        edge.from_from_to.inverse() *
        (before[edge.from].world_from_body.inverse() * before[edge.to].world_from_body);
    gaps.push_back(difference.translation.norm());
    angles.push_back(angle_between(difference.rotation, Rotation::Identity()));
  }
  const double gap = median_value(std::move(gaps));
  const double angle = median_value(std::move(angles));
  if (gap < kLeastGap && angle < kLeastAngle) return std::nullopt;
  double moved = 0.0, rotated = 0.0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const Pose& from = before[i].world_from_body;
    const Pose& to = corrected[i].world_from_body;
    moved = std::max(moved, (to.translation - from.translation).norm());
    rotated = std::max(rotated, angle_between(from.rotation, to.rotation));
  }
  if (moved >= kShare * gap || rotated >= std::max(kShare * angle, kLeastAngle)) {
    return std::nullopt;
  }
  return InputFinding{
      Fault::nothing_moved,
      fmt::format("no keyframe moved by more than {:.2g} m, although the closures differ from the "
                  "odometry by {:.3g} m and {:.3g} deg (median of {})",
                  moved,
                  gap,
                  kDegrees * angle,
                  problem.closures.size()),
      "search the closures and their information with doctor (GRAPH, or EST --loops FILE), or "
      "estimate the noise: --method motion_drift",
      gap > 0.0 ? 1.0 - moved / gap : 1.0,
      moved};
}

}  // namespace loopbench::metrics

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "metrics/doctor/agreement.hpp"
#include "metrics/doctor/graph_checks.hpp"
#include "metrics/numerics/angle.hpp"

namespace loopbench::metrics {

std::optional<InputFinding> check_movement(const Problem& problem, const Trajectory& corrected) {
  constexpr double kShare = 0.01, kLeastGap = 1e-3;  // [m]
  constexpr double kLeastAngle = 0.01 / kDegrees;
  const Trajectory& before = problem.keyframes;
  if (corrected.size() != before.size()) return std::nullopt;
  std::vector<double> gaps;
  for (const Edge& edge : problem.closures) {
    const Vector3 measured = before[edge.from].world_from_body * edge.from_from_to.translation;
    gaps.push_back((measured - before[edge.to].world_from_body.translation).norm());
  }
  const double gap = median_value(std::move(gaps));
  if (gap < kLeastGap) return std::nullopt;
  double moved = 0.0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const Pose& from = before[i].world_from_body;
    const Pose& to = corrected[i].world_from_body;
    moved = std::max(moved, (to.translation - from.translation).norm());
    if (angle_between(from.rotation, to.rotation) > kLeastAngle) return std::nullopt;
  }
  if (moved >= kShare * gap) return std::nullopt;
  return InputFinding{
      Fault::nothing_moved,
      fmt::format("no keyframe moved by more than {:.2g} m, although the closures differ from the "
                  "odometry by {:.3g} m (median of {})",
                  moved,
                  gap,
                  problem.closures.size()),
      "search the closures and their information with doctor (GRAPH, or EST --loops FILE), or "
      "estimate the noise: --method motion_drift",
      1.0 - moved / gap,
      moved};
}

}  // namespace loopbench::metrics

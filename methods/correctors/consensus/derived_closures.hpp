/// Closures that were computed from the odometry instead of measured.
#pragma once

#include <cstddef>
#include <vector>

#include "datasets/core/problem.hpp"

namespace loopbench::methods::consensus {

/// Whether each closure is the odometry between its keyframes to rounding (1e-5 rad, and 1e-5 of
/// the distance travelled): an edge of a covisibility graph, for example. It agrees with whatever
/// the odometry says, so that it is no evidence. O(keyframes + closures).
inline std::vector<bool> derived_closures(const Problem& problem) {
  constexpr double kRounding = 1e-5;
  std::vector<Pose> poses(problem.keyframes.size());
  std::vector<double> travelled(poses.size(), 0.0);   // [m]
  std::vector<std::size_t> missing(poses.size(), 0);  // steps without odometry before
  auto edge = problem.odometry.begin();
  for (std::size_t k = 0; k + 1 < poses.size(); ++k) {
    const bool is_measured = edge != problem.odometry.end() && edge->from == k;
    missing[k + 1] = missing[k] + (is_measured ? 0 : 1);
    travelled[k + 1] = travelled[k];
    if (!is_measured) continue;
    travelled[k + 1] += edge->from_from_to.translation.norm();
    poses[k + 1] = normalized(poses[k] * edge->from_from_to);
    ++edge;
  }
  std::vector<bool> out;
  for (const Edge& closure : problem.closures) {
    const Pose motion = poses[closure.from].inverse() * poses[closure.to];
    const Pose error = closure.from_from_to.inverse() * motion;
    const double length = travelled[closure.to] - travelled[closure.from];
    out.push_back(missing[closure.from] == missing[closure.to] &&
                  error.translation.norm() <= kRounding * length &&
                  log_so3(error.rotation).norm() <= kRounding);
  }
  return out;
}

}  // namespace loopbench::methods::consensus

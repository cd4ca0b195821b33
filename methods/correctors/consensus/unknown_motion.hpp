/// Steps of the odometry that state no motion.
#pragma once

#include <cmath>

#include "datasets/core/problem.hpp"

namespace loopbench::methods {

/// Whether an edge states no rotation: its deviations are half a turn or more about all axes (in
/// the plane: about its normal), beyond which an angle repeats. Odometry measures one, so that such
/// a step has unknown motion; options of datasets that free a step state it so.
inline bool is_unknown_motion(const Edge& edge, bool planar) {
  constexpr double kRounding = 1e-6;
  constexpr double kLargest = (1.0 + kRounding) / (M_PI * M_PI);
  const auto rotation = edge.information.diagonal().tail<3>();
  return planar ? rotation[2] <= kLargest : rotation.maxCoeff() <= kLargest;
}

}  // namespace loopbench::methods

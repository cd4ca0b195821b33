/// Compares the largest displacement of a correction with the displacement that the loop gaps
/// explain.
#pragma once

#include <Eigen/Core>

#include "datasets/core/problem.hpp"

namespace loopbench::methods {

struct LargestMove {
  double moved = 0.0;      ///< largest displacement of any keyframe [m]
  double explained = 0.0;  ///< largest displacement explained by the gap of one closure [m]
};

/// Computes both displacements. A gap of t [m] and r [rad] explains t + r R, where R is the
/// distance from the loop's last keyframe to the keyframe farthest from it. `gap` holds six numbers
/// per closure. O(keyframes closures).
LargestMove largest_move(const Problem& problem,
                         const Eigen::VectorXd& gap,
                         const Trajectory& corrected);

}  // namespace loopbench::methods

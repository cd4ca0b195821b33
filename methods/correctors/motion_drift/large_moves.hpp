/// Whether a correction moves the chain further than the gaps of its loops explain.
#pragma once

#include <Eigen/Core>

#include "datasets/core/problem.hpp"

namespace loopbench {

struct LargestMove {
  double moved = 0.0;      ///< largest displacement of a keyframe [m]
  double explained = 0.0;  ///< by the largest gap, its rotation at the chain's far end [m]
};

/// A gap of t [m] and r [rad] explains displacements of t + r R, R being the distance from the
/// loop's end to the farthest keyframe. `gap` holds six numbers per closure.
/// O(keyframes closures).
LargestMove largest_move(const Problem& problem,
                         const Eigen::VectorXd& gap,
                         const Trajectory& corrected);

}  // namespace loopbench

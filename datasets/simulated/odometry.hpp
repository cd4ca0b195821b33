/// Walking a path with an odometer that errs.
#pragma once

#include <cstddef>
#include <vector>

#include "datasets/core/problem.hpp"
#include "datasets/simulated/options.hpp"

namespace loopbench {

struct Odometry {
  Trajectory frames;        ///< the drifting world; its first pose is the true one
  std::vector<Edge> edges;  ///< between consecutive keyframes
};

/// A standard deviation [m], [rad] too small to matter, so that a noiseless edge has finite
/// information.
inline constexpr double kSigmaFloor = 1e-6;

/// Each step of `truth` is measured as step * exp(drift) * exp(noise). An edge's information is
/// the inverse of its steps' noise covariances, each carried by the adjoint to the edge's end and
/// summed; exact to first order in the noise. `keyframes` are ascending indices into `truth`.
/// When `planar`, noise has x, y and yaw only; the information keeps the rest so that it stays
/// positive definite. O(frames).
Odometry measure_odometry(const Trajectory& truth,
                          const std::vector<std::size_t>& keyframes,
                          const SimulatedOptions& options);

}  // namespace loopbench

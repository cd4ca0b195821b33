/// Simulated odometry with random and systematic errors.
#pragma once

#include <cstddef>
#include <vector>

#include "datasets/core/problem.hpp"
#include "datasets/simulated/options.hpp"

namespace loopbench {

struct Odometry {
  Trajectory frames;        ///< integrated odometry; the first pose is the true one
  std::vector<Edge> edges;  ///< between consecutive keyframes
};

/// Lower bound of standard deviations [m], [rad], so that a noise-free edge has finite information.
inline constexpr double kSigmaFloor = 1e-6;

/// Measures each step of `truth` as step * exp(drift) * exp(noise). The covariance of an edge is
/// the sum of the noise covariances of its steps, each transported by the adjoint to the end of the
/// edge; exact to first order in the noise. `keyframes` are ascending indices into `truth`. If
/// options.planar is set, noise affects x, y and yaw only; the information stays positive definite
/// in all axes. O(frames).
Odometry simulate_odometry(const Trajectory& truth,
                           const std::vector<std::size_t>& keyframes,
                           const SimulatedOptions& options);

}  // namespace loopbench

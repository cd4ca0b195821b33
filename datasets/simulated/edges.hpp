/// Simulated odometry, loop closures, true and false, and anchors.
#pragma once

#include <cstddef>
#include <vector>

#include "datasets/core/problem.hpp"
#include "datasets/derive/revisits.hpp"
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

struct SimulatedLoops {
  std::vector<Edge> closures;             ///< sorted by (to, from)
  std::vector<std::size_t> false_ones{};  ///< indices of those that connect different places
};

/// Returns at most closures.max true closures, subsampled evenly from all revisits and including
/// the last one, each measured as truth * exp(noise). Adds false closures, which connect different
/// places, until their share is closures.false_share. `truth` holds the true poses of the
/// keyframes. Throws OptionError if false closures are requested for a path that stays at one
/// place. O(poses).
SimulatedLoops simulate_closures(const Trajectory& truth,
                                 const RevisitRule& same,
                                 const SimulatedOptions& options);

/// Returns anchors.count measured positions of different keyframes, drawn at random, with normal
/// errors in x, y and, unless options.planar, z. Throws OptionError for more anchors than
/// keyframes. O(keyframes).
std::vector<Anchor> simulate_anchors(const Trajectory& truth, const SimulatedOptions& options);

}  // namespace loopbench

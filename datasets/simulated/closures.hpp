/// Simulated loop closures, true and false, and anchors.
#pragma once

#include <vector>

#include "datasets/core/problem.hpp"
#include "datasets/derive/revisits.hpp"
#include "datasets/simulated/options.hpp"

namespace loopbench {

/// Returns at most closures.max true closures, subsampled evenly from all revisits and including
/// the last one, each measured as truth * exp(noise). Adds false closures, which connect different
/// places, until their share is closures.false_share. Sorted by (to, from). `truth` holds the true
/// poses of the keyframes. Throws OptionError if false closures are requested for a path that stays
/// at one place. O(poses).
std::vector<Edge> simulate_closures(const Trajectory& truth,
                                    const RevisitRule& same,
                                    const SimulatedOptions& options);

/// Returns anchors.count measured positions of different keyframes, drawn at random, with normal
/// errors in x, y and, unless options.planar, z. Throws OptionError for more anchors than
/// keyframes. O(keyframes).
std::vector<Anchor> simulate_anchors(const Trajectory& truth, const SimulatedOptions& options);

}  // namespace loopbench

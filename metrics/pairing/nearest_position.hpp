/// Association in space, for routes that are repeated at other times.
#pragma once

#include "datasets/core/trajectory.hpp"
#include "metrics/protocols/protocol.hpp"

namespace loopbench::metrics {

/// The reference as it would be if it had been recorded with the estimate.
struct RepeatedRoute {
  Trajectory reference;  ///< nearest points of its path, at stamps of the estimate
  double visited = 0.0;  ///< share of the reference's poses near the estimate, 0..1
};

/// Pairs each pose of the estimate with the nearest point of the reference's path (linear and slerp
/// between poses) that is at most `farthest` away [m] and passed in the same direction: the
/// directions over `farthest` metres around both points differ by at most 90 degrees. Other poses
/// have no partner. Starts from the given frames and repeats pairing and alignment (iterated
/// closest points) until no pose moves by more than 1e-6 of `farthest`, at most 200 times; with
/// `align` none there is one pairing. Throws std::runtime_error if no pose has a partner, and as
/// align(). O(rounds n m / 32) in the worst case.
RepeatedRoute on_repeated_route(const Trajectory& reference,
                                const Trajectory& estimate,
                                double farthest,
                                Align align);

}  // namespace loopbench::metrics

/// When an estimate was silent although there was something to see.
#pragma once

#include <vector>

#include "datasets/core/trajectory.hpp"

namespace loopbench {

/// A pause of the estimate, on the reference's clock [s].
struct Loss {
  double begin = 0.0;
  double end = 0.0;
};

/// Pauses of the estimate longer than `longest_pause` [s] during which the reference, which has
/// poses there, moved away from where it was faster than `standing` [m/s] on average. Standing
/// still makes no keyframes, and a hole in the reference is no fault of the estimate. O(n + m).
std::vector<Loss> losses(const Trajectory& reference,
                         const Trajectory& estimate,
                         double offset,
                         double longest_pause,
                         double standing);

}  // namespace loopbench

/// When an estimate was silent although there was something to see.
#pragma once

#include <vector>

#include "datasets/core/problem.hpp"

namespace loopbench {

/// A pause of the estimate, on the reference's clock [s].
struct Loss {
  double begin = 0.0;
  double end = 0.0;
};

/// Pauses between the estimate's stamps longer than `longest_pause` [s] during which the reference,
/// which has poses there, moved away from where it was faster than `standing` [m/s] on average.
/// Standing still makes no keyframes, and a hole in the reference is no fault of the estimate. O(n
/// + m).
std::vector<Loss> losses(const Trajectory& reference,
                         const std::vector<double>& estimate,
                         double offset,
                         double longest_pause,
                         double standing);

/// Those of the losses longer than `longest_pause` [s] that are also ten times the median interval
/// between the stamps: keyframes may lie seconds apart throughout. O(n + m).
std::vector<Loss> tracking_gaps(const Trajectory& reference,
                                const std::vector<double>& estimate,
                                double offset,
                                double longest_pause);

/// Stamps at which the problem has a pose: its keyframes and the frames between them, ascending.
std::vector<double> tracked_stamps(const Problem& problem);

}  // namespace loopbench

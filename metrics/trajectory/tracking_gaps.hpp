/// Tracking gaps: pauses of the estimate while the reference moved.
#pragma once

#include <vector>

#include "datasets/core/problem.hpp"

namespace loopbench::metrics {

/// A pause of the estimate, in reference time [s].
struct TrackingGap {
  double begin = 0.0;
  double end = 0.0;
};

/// Pauses between the estimate's stamps longer than `longest_pause` [s] during which the reference
/// has poses and moved from its position with an average speed above `rest_speed` [m/s]. Keyframe
/// selection creates no keyframes at rest, and a reference gap is not an error of the estimate.
/// O(n + m).
std::vector<TrackingGap> gaps_while_moving(const Trajectory& reference,
                                           const std::vector<double>& estimate,
                                           double offset,
                                           double longest_pause,
                                           double rest_speed);

/// The pauses of gaps_while_moving() longer than `longest_pause` [s] that are also longer than ten
/// times the median interval between the stamps, since keyframes can be seconds apart everywhere.
/// O(n + m).
std::vector<TrackingGap> tracking_gaps(const Trajectory& reference,
                                       const std::vector<double>& estimate,
                                       double offset,
                                       double longest_pause);

/// Time between the stamps that an estimate does not cover [s]: its tracking gaps, and what other
/// pauses while the reference moves exceed 5 s by: poses that are farther apart show little of the
/// path between them. O(n + m).
double uncovered_time(const Trajectory& reference,
                      const std::vector<double>& estimate,
                      double longest_pause);

/// Stamps at which the problem has a pose: its keyframes and the frames between them, ascending.
std::vector<double> tracked_stamps(const Problem& problem);

}  // namespace loopbench::metrics

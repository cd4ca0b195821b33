/// Time offset between two trajectories, from their speeds.
#pragma once

#include <optional>

#include "metrics/doctor/common_motion.hpp"
#include "metrics/doctor/finding.hpp"

namespace loopbench::metrics {

struct TimeOffset {
  double offset = 0.0;          ///< to add to the estimate's stamps [s]
  double deviation = 0.0;       ///< standard deviation [s]
  double correlation = 0.0;     ///< of the speeds at the offset, mean of linear and angular speed
  double before = 0.0;          ///< the same at offset 0; 0 without common times
  bool has_common_time = true;  ///< at offset 0
};

/// Correlation of the speeds as read; 0 without common times. O(1e3 log n).
double speed_correlation(const Trajectory& reference, const Trajectory& estimate);

/// The offset with the largest correlation of linear and angular speed: at most `searched` [s], or
/// over all overlaps if the trajectories have no common time; refined to a fraction of a sample. An
/// offset below 1 s is preferred to a larger one that fits equally well, as periodic motion has.
/// The deviation follows from the residuals of the speeds and their slopes. nullopt without enough
/// motion, or if no offset explains the speeds (correlation below 0.6). Compares at most 20 000
/// offsets of a range. O(1e7).
std::optional<TimeOffset> estimate_time_offset(const Trajectory& reference,
                                               const Trajectory& estimate,
                                               double searched = 10.0);

/// A finding if the offset is significant (five standard deviations, above 20 ms and 35 % of the
/// estimate's interval) and reduces the errors after an alignment. Files without common time need a
/// correlation of 0.85 instead: those of different recordings reach 0.75.
std::optional<InputFinding> offset_finding(const TimeOffset& found,
                                           const Trajectory& reference,
                                           const Trajectory& estimate);

}  // namespace loopbench::metrics

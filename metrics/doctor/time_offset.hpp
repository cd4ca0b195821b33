/// Time offset between two trajectories, from their speeds.
#pragma once

#include <optional>

#include "datasets/core/trajectory.hpp"
#include "metrics/doctor/finding.hpp"

namespace loopbench::metrics {

struct TimeOffset {
  double offset = 0.0;       ///< to add to the estimate's stamps [s]
  double deviation = 0.0;    ///< standard deviation [s]
  double correlation = 0.0;  ///< of the speeds at the offset, mean of linear and angular speed
  double before = 0.0;       ///< the same at offset 0; 0 without common times
  /// 1 - correlation at the offset over that at 0, of the speed for which this is smaller.
  double unexplained = 1.0;
  bool has_common_time = true;  ///< at offset 0
};

/// The offset with the largest correlation of linear and angular speed: searched within 10 s, or
/// over all overlaps if the trajectories have no common time; refined to a fraction of a sample. An
/// offset below 1 s is preferred to a larger one that fits equally well, as periodic motion has.
/// The deviation follows from the residuals of the speeds and their slopes. nullopt without enough
/// motion, or if no offset explains the speeds (correlation below 0.6). O(1e6).
std::optional<TimeOffset> estimate_time_offset(const Trajectory& reference,
                                               const Trajectory& estimate);

/// A finding if the offset is significant (four standard deviations, above 40 ms and 60 % of the
/// estimate's interval) and gives a clearly higher correlation of the speeds than no offset: by
/// 0.005, or by 0.0005 and half of what is missing to 1. Files without common time need a
/// correlation of 0.85: those of different recordings reach 0.75 at some offset.
std::optional<InputFinding> offset_finding(const TimeOffset& found, const Trajectory& estimate);

}  // namespace loopbench::metrics

/// Checks of the stamps and of the content of two files.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "metrics/doctor/finding.hpp"
#include "metrics/doctor/sampling.hpp"

namespace loopbench::metrics {

inline constexpr double kLeastCorrelation = 0.6;  ///< of different recordings: 0.3, rarely 0.6

struct TimeOffset {
  double offset = 0.0;          ///< to add to the estimate's stamps [s]
  double deviation = 0.0;       ///< standard deviation [s]
  double agreement = 0.0;       ///< of the speeds: `correlation`, less for one kind of speed
  double correlation = 0.0;     ///< at the offset: mean of linear and angular speed, or of one
  double before = 0.0;          ///< the same at offset 0; 0 without common times
  bool has_common_time = true;  ///< at offset 0
  double odds = 0.0;            ///< logarithm of those of the offset to the next likely one

  /// Half of the 95 % interval [s], with the scatter of twenty parts (Student).
  double half_interval() const { return 2.1 * deviation; }
};

/// Correlation of the speeds as read; 0 without common times. O(log n).
double speed_correlation(const Trajectory& reference, const Trajectory& estimate, double offset);

/// The offset with the most likely correlation of linear and angular speeds over one second
/// (longer for sparse poses and long recordings), over all overlaps of at least three tenths of the
/// shorter file: on a coarse grid, then refined to a fraction of a sample. The deviation is that of
/// twenty parts, whose errors can be correlated within. nullopt if no offset explains the speeds
/// (agreement below 0.6), or if another one is nearly as likely (1 to 20), as for equal laps.
/// O(1e6) at most.
std::optional<TimeOffset> estimate_time_offset(const Trajectory& reference,
                                               const Trajectory& estimate);

/// A finding if the offset is significant (five standard deviations, above 20 ms and 35 % of the
/// estimate's interval) and reduces the errors after an alignment. Offsets above 10 s, and of files
/// without common time, need larger odds. Without stamps, the offset is one of rows, and has to be
/// a whole number of them.
std::optional<InputFinding> offset_finding(const TimeOffset& found,
                                           const Trajectory& reference,
                                           const Trajectory& estimate,
                                           bool has_stamps);

/// Speeds agree only with another rate of the stamps: the estimate is of the same recording, but
/// its stamps are frame numbers, or frames were dropped before stamps were written. O(1e5 log n).
std::optional<InputFinding> check_rate(const Trajectory& reference, const Trajectory& estimate);

/// The stamps of one file fit those of the other only after division by 10^3, 10^6 or 10^9; value:
/// the divisor of the estimate's stamps, or its inverse for the reference's. O(1).
std::optional<InputFinding> check_stamp_unit(const Trajectory& reference,
                                             const Trajectory& estimate);

/// The time ranges do not overlap. O(1).
std::optional<InputFinding> check_overlap(const Trajectory& reference,
                                          const Trajectory& estimate,
                                          double offset);

/// The estimate has no poses in at least a quarter of the reference's path, in gaps above 2 s and
/// ten of its usual intervals. O(log n).
std::optional<InputFinding> check_missing(const Trajectory& reference,
                                          const Trajectory& estimate,
                                          double offset);

/// Only the estimate's name contains a word like "groundtruth". Rates are no evidence: correct
/// references are sparser than estimates, or denser. O(1).
std::optional<InputFinding> check_swapped(const std::string& reference_name,
                                          const std::string& estimate_name);

/// Up to a sixth of all steps of `file` are jumps; `other` shows how far it should move. Outliers
/// are removed, and other jumps undone, if that reduces the position error. O(log n).
std::optional<InputFinding> remove_jumps(Paired& poses, bool of_reference);

/// Of order and sign of quaternions, inverted poses, axes, units of lengths, scale, rotation and
/// lever arm of the body, the repair with the largest gain. It has to reduce the sum of errors
/// clearly and at least one error by a quarter, on poses that it was not fitted to. nullopt if
/// there is none with another fault than `found`, or if the poses agree. O(n).
/// `has_positions_only`: the reference has no rotations, so that it can follow an antenna.
std::optional<InputFinding> apply_best_repair(Paired& poses,
                                              const std::vector<InputFinding>& found,
                                              bool has_positions_only = false);

}  // namespace loopbench::metrics

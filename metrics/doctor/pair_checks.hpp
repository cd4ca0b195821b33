/// Checks of the stamps and of the content of two files.
#pragma once

#include <optional>
#include <string>

#include "metrics/doctor/agreement.hpp"
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

/// The offset with the largest correlation of linear and angular speed: at most `searched` [s], by
/// default 10; over all overlaps if the trajectories have no common time or, by default, if no such
/// offset explains the speeds (GPS time is 18 s ahead). Refined to a fraction of a sample. An
/// offset below 1 s is preferred to a larger one that fits equally well, as periodic motion has.
/// The deviation follows from the residuals of the speeds and their slopes. nullopt without enough
/// motion, or if no offset explains the speeds (correlation below 0.6). Compares at most 20 000
/// offsets of a range. O(1e7).
std::optional<TimeOffset> estimate_time_offset(const Trajectory& reference,
                                               const Trajectory& estimate,
                                               std::optional<double> searched = {});

/// A finding if the offset is significant (five standard deviations, above 20 ms and 35 % of the
/// estimate's interval) and reduces the errors after an alignment. Files without common time, and
/// offsets above 10 s, need a correlation of 0.85: those of different recordings reach 0.75.
std::optional<InputFinding> offset_finding(const TimeOffset& found,
                                           const Trajectory& reference,
                                           const Trajectory& estimate);

// Those with changeable poses correct what they find in them.

/// The stamps of one file fit those of the other only after division by 10^3, 10^6 or 10^9. O(n).
std::optional<InputFinding> repair_stamp_unit(Trajectory& reference, Trajectory& estimate);

/// The estimate's stamps grow at another rate, with which speeds agree: whole numbers or rows at a
/// usual frame rate, a recording that was played at another speed, every k-th row. O(1e8).
std::optional<InputFinding> repair_rate(const Trajectory& reference,
                                        Trajectory& estimate,
                                        bool has_stamps);

/// The offset of the estimate grows steadily over its three thirds, or jumps between its five
/// fifths, and relative rotations (without rotations: positions) have smaller errors with these
/// offsets. O(1e7).
std::optional<InputFinding> repair_clock(const Trajectory& reference,
                                         Trajectory& estimate,
                                         bool has_stamps);

/// The time ranges do not overlap; a finding of frame indices if only the estimate's stamps are
/// whole numbers. O(n).
std::optional<InputFinding> check_overlap(const Trajectory& reference, const Trajectory& estimate);

/// The estimate has no poses in at least a quarter of the reference's path, or in 12 % between its
/// first and last pose, in gaps above 2 s and ten of its usual intervals. O(n).
std::optional<InputFinding> check_missing(const Trajectory& reference, const Trajectory& estimate);

/// Only the estimate's name contains a word like "groundtruth". Rates are no evidence: correct
/// references are sparser than estimates, or denser. O(1).
std::optional<InputFinding> check_swapped(const std::string& reference_name,
                                          const std::string& estimate_name);

/// The estimate's rotations over short distances are 57.3 times those of the reference, or a 57th.
/// O(n).
std::optional<InputFinding> check_angle_unit(const Paired& poses);

// The first file is changed, the other one shows how far it should move.

/// Rows that repeat the position before while the other file moves: tracking was lost. They are
/// removed if that reduces the position error. O(n + m).
std::optional<InputFinding> remove_standstill(Trajectory& file,
                                              const Trajectory& other,
                                              const std::string& name);

/// Up to a sixth of all steps are jumps. Outliers are removed, and other jumps undone, if that
/// reduces the position error. O(n + m).
std::optional<InputFinding> remove_jumps(Trajectory& file,
                                         const Trajectory& other,
                                         const std::string& name);

/// Rows in the order of names: "10" before "2". O(n log n + m).
std::optional<InputFinding> repair_order(Trajectory& file,
                                         const Trajectory& other,
                                         const std::string& name);

/// Of order and sign of quaternions, inverted poses, axes, units of lengths, scale, rotation and
/// lever arm of the body, the repair with the largest gain. It has to reduce the sum of errors
/// clearly and at least one error by a quarter, on poses that it was not fitted to. nullopt if
/// there is none with another fault than `found`, or if the poses agree. O(n).
std::optional<InputFinding> apply_best_repair(Paired& poses,
                                              const std::vector<InputFinding>& found);

}  // namespace loopbench::metrics

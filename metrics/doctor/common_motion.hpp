/// Motion of reference and estimate over the same intervals.
#pragma once

#include <vector>

#include "datasets/core/trajectory.hpp"

namespace loopbench::metrics {

/// Poses of both trajectories at the same times.
struct CommonPoses {
  std::vector<Pose> reference;
  std::vector<Pose> estimate;
  std::vector<double> stamps;  ///< of the estimate [s]
};

/// The estimate's poses, at most `most` of them, evenly chosen, with the reference interpolated at
/// stamp + offset; without those outside the reference or in its gaps above 1 s (or ten times its
/// median interval). O(m log n).
CommonPoses common_poses(const Trajectory& reference,
                         const Trajectory& estimate,
                         double offset,
                         std::size_t most);

/// Magnitudes of motion over consecutive intervals: independent of world frames and of the body's
/// axes.
struct MotionSignals {
  std::vector<double> reference_angle, estimate_angle;        ///< [rad]
  std::vector<double> reference_distance, estimate_distance;  ///< [m]
  std::vector<double> duration;                               ///< [s]
};

/// Median time between poses [s]; of at most 20 000 evenly chosen steps. 0 below two poses.
double usual_interval(const Trajectory& poses);

/// Index of the first pose at or after `stamp`, or the number of poses. Searches around `hint` in
/// steps that double, so a good hint costs O(1). O(log n).
std::size_t first_from(const Trajectory& poses, double stamp, std::size_t hint);

/// Pearson's correlation; 0 for fewer than five values or a constant.
double correlation(const std::vector<double>& a, const std::vector<double>& b);

inline constexpr double kLeastOfNoise = 3.0;  ///< standard deviation of positions over their noise

/// Whether noise explains the positions: their standard deviation is at most kLeastOfNoise times
/// the one of white noise that the deviations from straight lines between neighbours have. O(n).
bool is_at_rest(const Trajectory& poses);

/// Median; 0 for an empty list.
double median_value(std::vector<double> values);

}  // namespace loopbench::metrics

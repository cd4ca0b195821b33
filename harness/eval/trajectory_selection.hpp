/// Selection of poses: by time range, number, or motion since the last selected pose.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "datasets/formats/trajectory_file.hpp"

namespace loopbench::harness {

/// Indices of the poses with start <= stamp <= end, as evo's --t_start and --t_end. O(n).
std::vector<std::size_t> within(const Trajectory& poses, double start, double end);

/// `count` evenly spaced indices from the first to the last pose, rounded down as evo's
/// --downsample (numpy.linspace); all if there are fewer. `count` must be at least 1. O(count).
std::vector<std::size_t> evenly_spaced(std::size_t poses, std::size_t count);

/// Thresholds of motion; nothing: no limit. Reaching any of them is enough.
struct MotionStep {
  std::optional<double> seconds;
  std::optional<double> metres;   ///< path length
  std::optional<double> degrees;  ///< rotation angle; accumulated for resampled()
};

/// The first pose, then each pose at which a threshold is reached since the last selected one, as
/// evo's --motion_filter: the path length in between, or the angle between the two poses. O(n).
std::vector<std::size_t> by_motion(const Trajectory& poses, const MotionStep& step);

/// Poses interpolated (linear, SLERP) at multiples of exactly one of the three steps: of time from
/// the first stamp, of path length or of accumulated rotation along the polyline. Throws
/// InputError unless exactly one is given and positive, or if there would be more than 1e8 poses.
/// O(n + result).
Trajectory resampled(const Trajectory& poses, const MotionStep& step);

/// Number of poses of `result` strictly between two poses that are more than `gap` apart [s]. O(n).
std::size_t poses_in_gaps(const Trajectory& poses, const Trajectory& result, double gap);

/// The first pose of each lap, and the first pose after the last complete one: {0} without a lap. A
/// lap ends where the path returns to within `radius` of its first position [m], after it has left,
/// in the direction in which it left: at the nearest pose of this visit. O(n).
std::vector<std::size_t> lap_starts(const Trajectory& poses, double radius);

/// All poses in the order of their stamps. Of poses with equal stamps, the one of the first or of
/// the last file is kept, and the others are added to `dropped`, which has an element per file.
/// Throws InputError if repeats are refused and there are any. O(n log n).
TrajectoryFile merged(const std::vector<TrajectoryFile>& files,
                      Repeats repeats,
                      std::vector<std::size_t>& dropped);

}  // namespace loopbench::harness

/// Selection of poses: by time range, number, or motion since the last selected pose.
#pragma once

#include <cstddef>
#include <vector>

#include "datasets/formats/trajectory_file.hpp"

namespace loopbench::harness {

/// Indices of the poses with start <= stamp <= end, as evo's --t_start and --t_end. O(n).
std::vector<std::size_t> within(const Trajectory& poses, double start, double end);

/// `count` evenly spaced indices from the first to the last pose, rounded down as evo's
/// --downsample (numpy.linspace); all if there are fewer. `count` must be at least 1. O(count).
std::vector<std::size_t> evenly_spaced(std::size_t poses, std::size_t count);

/// The first pose, then each pose at which a threshold is reached since the last selected one, as
/// evo's --motion_filter: the path length in between [m], or the angle between the two poses [deg],
/// which never reaches more than 180. Throws InputError if an angle needs rotations that the poses
/// lack. O(n).
std::vector<std::size_t> by_motion(const Trajectory& poses, double metres, double degrees);

/// All poses in the order of their stamps. Of poses with equal stamps, the one of the first or of
/// the last file is kept, and the others are added to `dropped`, which has an element per file.
/// Throws InputError if repeats are refused and there are any. O(n log n).
TrajectoryFile merged(const std::vector<TrajectoryFile>& files,
                      Repeats repeats,
                      std::vector<std::size_t>& dropped);

}  // namespace loopbench::harness

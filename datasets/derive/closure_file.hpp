/// Text files of loop closures by time, which are independent of the choice of keyframes.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "datasets/core/problem.hpp"
#include "datasets/derive/closures.hpp"

namespace loopbench {

struct StampedClosure {
  double stamp_from = 0.0;  ///< [s]
  double stamp_to = 0.0;    ///< [s]
  Pose from_from_to;
  ClosureNoise noise;
  std::size_t line = 0;  ///< line number in the file
};

/// Reads one closure per line: `stamp_from stamp_to tx ty tz qx qy qz qw [sigma_t sigma_r]` in [s],
/// [m], [rad]. The pose is that of the body at stamp_to in the frame of the body at stamp_from;
/// either stamp may be the later one. Lines that start with `#` are comments. Lines without sigmas
/// use `noise`. Throws InputError `file:line: what`. O(size of the file).
std::vector<StampedClosure> read_closure_file(const std::filesystem::path& file,
                                              const ClosureNoise& noise);

/// Converts closures to edges between the nearest poses in time, at most `max_diff` [s] away. Edges
/// have from < to and are sorted by (to, from). Throws InputError `file:line: what` if there is no
/// such pose or if both stamps match the same pose.
std::vector<Edge> as_edges(const std::vector<StampedClosure>& closures,
                           const Trajectory& poses,
                           double max_diff,
                           const std::filesystem::path& file);

}  // namespace loopbench

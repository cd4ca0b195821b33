/// Loop closures written as text, by time: they stay right whatever keyframes are chosen.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "datasets/core/problem.hpp"
#include "datasets/derive/closures.hpp"

namespace loopbench {

struct TimedClosure {
  double stamp_from = 0.0;  ///< [s]
  double stamp_to = 0.0;    ///< [s]
  Pose from_from_to;
  ClosureNoise noise;
  std::size_t line = 0;  ///< in its file
};

/// One closure a line: `stamp_from stamp_to tx ty tz qx qy qz qw [sigma_t sigma_r]`, in [s], [m],
/// [rad]: the pose of the body at stamp_to, seen from the body at stamp_from. Either may be the
/// later. Lines that start with `#` are comments; lines without sigmas take `noise`.
/// Throws InputError `file:line: what`. O(size of the file).
std::vector<TimedClosure> read_closure_file(const std::filesystem::path& file,
                                            const ClosureNoise& noise);

/// The same as edges between the nearest poses, at most `max_diff` [s] away; from < to, in the
/// order that Problem promises. Throws InputError `file:line:` when there is no such pose or both
/// ends are the same.
std::vector<Edge> as_edges(const std::vector<TimedClosure>& closures,
                           const Trajectory& poses,
                           double max_diff,
                           const std::filesystem::path& file);

}  // namespace loopbench

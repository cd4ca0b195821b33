/// Pose pairs of a relative error that are `delta` apart in frames, seconds or metres.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "datasets/core/trajectory.hpp"

namespace loopbench::metrics {

using FromTo = std::pair<std::size_t, std::size_t>;

/// (i, i + delta) for every i. delta >= 1; empty if the list is not longer than delta.
std::vector<FromTo> pairs_by_frames(std::size_t size, std::size_t delta);

/// For every i the later j whose measure[j] - measure[i] is nearest to delta (the first of equals),
/// kept if it differs from delta by at most `tolerance`. `measure` never decreases: stamps [s] or
/// accumulated distance [m]. This is evo's "all pairs" rule for metres. O(n) on moving
/// trajectories, O(n log n) in the worst case.
std::vector<FromTo> pairs_by_measure(const std::vector<double>& measure,
                                     double delta,
                                     double tolerance);

/// Path length from the first pose to each pose [m].
std::vector<double> accumulated_distances(const Trajectory& trajectory);

}  // namespace loopbench::metrics

/// Pose pairs of a relative error that are `delta` apart in frames, seconds, metres or angle.
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

/// (0, d), (d, 2d), ...; evo core/filters.py, filter_pairs_by_index. delta >= 1.
std::vector<FromTo> consecutive_frames(std::size_t size, std::size_t delta);

/// Whether pose 0 starts the first pair. evo skips it for metres, but not for angles.
enum class FirstPose { starts, left_out };

/// Accumulates `steps` (steps[i] leads to pose i, steps[0] = 0), cuts where the sum reaches delta,
/// and pairs consecutive cuts. evo core/filters.py, by path length and by angle. O(n).
std::vector<FromTo> consecutive_by_measure(const std::vector<double>& steps,
                                           double delta,
                                           FirstPose first);

/// From each end to the later stamp nearest to `delta` ahead (the first of equals), if it differs
/// from delta by at most `tolerance`; otherwise the next stamp is tried as a start. Ascending
/// stamps [s]. evo has no such rule. O(n).
std::vector<FromTo> consecutive_seconds(const std::vector<double>& stamps,
                                        double delta,
                                        double tolerance);

/// Every i < j whose relative rotation angle is within `tolerance` of `angle` [rad], both limits
/// included, ordered by i, then j: evo's all-pairs rule for angles. The result can hold n^2 / 2
/// pairs. Otherwise O((n + pairs) log n) for steady rotation: intervals of the trajectory are
/// bounded by a middle orientation and the largest angle to it, and accepted or skipped as a whole.
/// O(n^2) if the orientation jumps from pose to pose.
std::vector<FromTo> angle_pairs(const Trajectory& trajectory, double angle, double tolerance);

}  // namespace loopbench::metrics

/// Consecutive pose pairs, evo's default.
#pragma once

#include "metrics/pairing/pair_search.hpp"

namespace loopbench::metrics {

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

}  // namespace loopbench::metrics

/// One stretch after the other, as evo's default pairs.
#pragma once

#include "metrics/pairing/pair_search.hpp"

namespace loopbench {

/// (0, d), (d, 2d), ...; evo core/filters.py, filter_pairs_by_index. delta >= 1.
std::vector<FromTo> consecutive_frames(std::size_t size, std::size_t delta);

/// Is pose 0 the start of the first stretch? evo's metres leave it out, its angles do not.
enum class FirstPose { starts, left_out };

/// Adds up `steps` (steps[i] leads to pose i, steps[0] = 0) and cuts where the sum reaches delta;
/// pairs the cuts that follow each other. evo core/filters.py, by path and by angle. O(n).
std::vector<FromTo> consecutive_stretches(const std::vector<double>& steps,
                                          double delta,
                                          FirstPose first);

/// From each end on, to the later stamp nearest to `delta` ahead (the first of equals), when that
/// misses by at most `tolerance`; where none does, the next stamp is tried as a start. Ascending
/// stamps [s]. evo has no such rule. O(n).
std::vector<FromTo> consecutive_seconds(const std::vector<double>& stamps,
                                        double delta,
                                        double tolerance);

}  // namespace loopbench

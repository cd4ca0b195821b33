/// One stretch after the other, as evo's default pairs.
#pragma once

#include "metrics/pair_search.hpp"

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

}  // namespace loopbench

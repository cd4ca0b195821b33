/// Loop closures as a place recogniser would report them, true and false.
#pragma once

#include <vector>

#include "datasets/core/problem.hpp"
#include "datasets/revisits.hpp"
#include "datasets/simulated/options.hpp"

namespace loopbench {

/// True closures: at most options.max revisits, evenly spread over all that there are and always
/// with the last one, each measured as truth * exp(noise); then false_share of the result false:
/// two places that are not the same taken for the same. Sorted by (to, from). `truth` are the
/// keyframes' true poses. Throws OptionError when false ones are asked for on a path that never
/// leaves its place. O(poses).
std::vector<Edge> measure_closures(const Trajectory& truth,
                                   const RevisitRule& same,
                                   const SimulatedOptions& options);

}  // namespace loopbench

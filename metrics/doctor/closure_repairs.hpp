/// Candidate corrections of the conventions of closures and odometry.
#pragma once

#include <optional>

#include "datasets/core/problem.hpp"
#include "metrics/doctor/closure_chain.hpp"
#include "metrics/doctor/finding.hpp"

namespace loopbench::metrics {

/// The correction of direction or unit of the odometry that makes it agree with the keyframes,
/// whose poses a file can state on their own. nullopt if there is none. O(keyframes).
std::optional<InputFinding> find_odometry_repair(const Problem& problem);

/// The correction of direction, order of quaternions, units or frame of the closures that makes
/// them likelier: see LoopGroup. Groups of neighbouring closures are compared one by one, so that
/// false closures spoil few of them. The correction is chosen by every other group, and has to
/// make the remaining ones likelier too (all, if there are less than six). nullopt if there is
/// none. O(keyframes + closures log).
std::optional<InputFinding> find_closure_repair(const Problem& problem, const Chain& chain);

}  // namespace loopbench::metrics

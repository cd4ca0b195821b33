/// Candidate corrections of the conventions of closures and odometry.
#pragma once

#include <optional>

#include "datasets/core/problem.hpp"
#include "metrics/doctor/finding.hpp"

namespace loopbench::metrics {

/// The correction of direction or unit of the odometry that makes it agree with the keyframes,
/// whose poses a file can state on their own. nullopt if there is none. O(keyframes).
std::optional<InputFinding> find_odometry_repair(const Problem& problem);

/// The correction of direction, order of quaternions, units or frame of the closures that makes
/// closures agree best with the odometry and their neighbours. It is chosen by every other pair of
/// closures and has to halve the errors of the remaining ones; they are measured between
/// neighbours, which share their drift, and over whole loops. nullopt if there is none. The
/// odometry has to be a chain. O(keyframes + closures).
std::optional<InputFinding> find_closure_repair(const Problem& problem);

}  // namespace loopbench::metrics

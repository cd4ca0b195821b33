/// Checks of the edges of a pose graph: conventions, false closures, information.
#pragma once

#include <optional>
#include <vector>

#include "datasets/core/problem.hpp"
#include "metrics/doctor/finding.hpp"
#include "metrics/doctor/loop_likelihood.hpp"

namespace loopbench::metrics {

/// The correction of direction, unit or order of quaternions of the odometry that makes it agree
/// with the keyframes, whose poses a file can state on their own. nullopt if there is none.
/// O(edges).
std::optional<InputFinding> find_odometry_repair(const Problem& problem);

/// The same for direction, unit, rotations or frame of the closures, where drift is small.
std::optional<InputFinding> find_closure_repair_by_keyframes(const Problem& problem);

/// The correction of direction, order of quaternions, units or frame of the closures that makes
/// them likelier: see LoopGroup. Groups of neighbouring closures are compared one by one, so that
/// false closures spoil few of them. The correction is chosen by every other group, and has to
/// make the remaining ones likelier too (all, if there are less than six). nullopt if there is
/// none. O(keyframes + closures log).
std::optional<InputFinding> find_closure_repair(const Problem& problem, const Chain& chain);

/// Less than half of the stamps of loops are at most 20 ms from a pose: other units, frame numbers,
/// another clock or another recording. O(loops poses log).
std::optional<InputFinding> check_loop_stamps(const std::vector<double>& loops,
                                              const Trajectory& poses);

/// Removes closures that state the identity or no rotation, as if a place recogniser had measured
/// no relative poses, if they are at least a fifth. O(closures).
std::optional<InputFinding> remove_unmeasured(std::vector<Edge>& closures, const Chain& chain);

/// Exchanged blocks of all information, or information that differs from the noise which makes the
/// loops likeliest by more than 100 (too large) or 10^5 (too small). O(closures).
std::optional<InputFinding> check_information(const Problem& problem);

/// Compares closures with the odometry, without a reference:
/// - conventions of odometry and closures, see the functions above;
/// - gaps of closures that the odometry or most other closures contradict;
/// - order and scale of the information, by the noise that fits the loops, without the closures
///   found before, and only if these are less than a fifth.
/// If the odometry is no chain, only the first, by the keyframes. O((closures + keyframes) log).
std::vector<InputFinding> check_closures(const Problem& problem);

}  // namespace loopbench::metrics

/// Checks of the edges of a pose graph: conventions, false closures, information.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "datasets/core/problem.hpp"
#include "methods/correctors/consensus/judgement.hpp"
#include "metrics/doctor/finding.hpp"
#include "metrics/doctor/loop_chain.hpp"

namespace loopbench::metrics {

/// The correction of direction, order of quaternions or frame of the closures with which odometry
/// and other closures predict them better: chosen by every other closure, it has to reduce the
/// median chi-squared of the remaining ones (of all, if there are less than six). Either the stated
/// noise does not explain it as read, or significantly more closures agree with others afterwards.
/// nullopt if there is none, and for one or two closures. O(closures).
std::optional<InputFinding> find_closure_repair(const std::vector<LoopPaths>& loops,
                                                const Chain& chain);

/// Edges of the odometry that fit the keyframes in the other direction, or edges whose translations
/// are in the axes of the world: nearly all fit better, and their median distance from the motion
/// between the keyframes is at most a quarter. nullopt otherwise, and for less than six. O(edges).
std::optional<InputFinding> check_edge_frames(const Problem& problem);

/// Less than half of the stamps of loops are at most 20 ms from a pose: other units, frame numbers,
/// another clock or another recording. O(loops poses log).
std::optional<InputFinding> check_loop_stamps(const std::vector<double>& loops,
                                              const Trajectory& poses);

/// Compares closures with the odometry, without a reference:
/// - translations and directions that are not those of the file's kind, see check_edge_frames(),
///   which is then the only finding;
/// - identities that were not measured;
/// - direction and conventions, see find_closure_repair(), from six closures in graphs with scales;
/// - closures that the others contradict, and deviations that are not those stated, as judged
///   together by judge_closures(). In graphs with scales, which that does not judge, or if the
///   closures do not decide: gaps of closures that the odometry or most other closures contradict,
///   and information by the median chi-squared of the gaps (above 100 or below 10^-4).
/// Identities and conventions are not accused if nearly all closures agree with the stated
/// deviations. Where the odometry is no chain, only the judgement is used. `known`: judgement of
/// this problem; null: it is computed. O(closures^2 + keyframes).
std::vector<InputFinding> check_closures(const Problem& problem,
                                         const methods::ClosureJudgement* known = nullptr);

}  // namespace loopbench::metrics

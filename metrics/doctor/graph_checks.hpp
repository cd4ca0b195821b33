/// Checks of the edges of a pose graph: conventions, false closures, information, effect.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

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

struct GapCheck {
  std::optional<InputFinding> finding;
  std::vector<std::size_t> closures;  ///< indices of the false ones
};

/// Closures that end more than 2 m from the odometry along their loop and more than eight times the
/// drift per distance of the median loop (at most 35 % of the loop's length). With at least ten
/// closures, the same for the paths over odometry and one other closure: two of the three shortest
/// have to contradict. A finding if the gaps are smaller by 10 % without them. O(closures log).
GapCheck check_gaps(const std::vector<Edge>& closures, const Chain& chain);

/// Compares the gaps of all loops with the covariance of odometry and closures. Medians of
/// translation and rotation far from 1, but near 1 after exchange of the blocks: wrong order. Far
/// from 1 otherwise: wrong scale, of the odometry only if pairs of neighbouring closures agree with
/// their covariance. Only these pairs far from it: wrong scale of the closures. The factor of a
/// wrong scale is fitted to every other gap, and has to bring the remaining ones closer to 1.
/// O(closures).
std::optional<InputFinding> check_information(const Problem& problem);

/// A finding if the closures differ from the odometry, but no keyframe has moved by a hundredth of
/// their median distance or rotated by 0.01 deg. `corrected`: the keyframes after the correction,
/// as many as before. nullopt without closures or if their median distance is below 1 mm.
/// O(keyframes + closures).
std::optional<InputFinding> check_movement(const Problem& problem, const Trajectory& corrected);

/// Compares closures with the odometry, without a reference:
/// - conventions of odometry and closures, see find_odometry_repair() and find_closure_repair();
/// - gaps, see check_gaps();
/// - information, see check_information(), without the closures found before, and only if these
///   are less than a fifth.
/// Empty if the odometry is no chain. O((closures + keyframes) log).
inline std::vector<InputFinding> check_closures(const Problem& problem) {
  std::vector<InputFinding> out;
  const bool is_chain = problem.odometry.size() + 1 == problem.keyframes.size();
  if (problem.closures.empty() || !is_chain) return out;
  const Chain chain = chain_of(problem);
  if (auto repair = find_odometry_repair(problem)) return {*repair};
  const GapCheck gaps = check_gaps(problem.closures, chain);
  const bool are_few_false = 5 * gaps.closures.size() < problem.closures.size();
  if (auto repair = find_closure_repair(problem, chain)) {
    // Smaller translations of all closures also shrink the gaps of a few false ones.
    const bool is_unit = repair->fault == Fault::closure_unit;
    if (!(is_unit && gaps.finding && are_few_false)) return {*repair};
  }
  if (gaps.finding) out.push_back(*gaps.finding);
  if (are_few_false) {  // false closures show nothing about the information
    Problem plausible = problem;
    plausible.closures.clear();
    for (std::size_t i = 0; i < problem.closures.size(); ++i) {
      if (std::ranges::count(gaps.closures, i) == 0)
        plausible.closures.push_back(problem.closures[i]);
    }
    if (auto found = check_information(plausible)) out.push_back(*found);
  }
  std::erase_if(out, [](const InputFinding& f) { return f.confidence < kLeastConfidence; });
  return out;
}

}  // namespace loopbench::metrics

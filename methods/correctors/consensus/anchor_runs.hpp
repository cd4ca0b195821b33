/// Consecutive anchors that are shifted together, as by a wrong datum or in a street of
/// reflections.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "datasets/core/problem.hpp"
#include "datasets/core/upper_median.hpp"
#include "methods/correctors/consensus/anchor_search.hpp"

namespace loopbench::methods::consensus {

struct ShiftedRun {
  AnchorRun run;
  AnchorExplanation without;  ///< the best without the anchors of the run
};

/// Where the errors of consecutive anchors change by most: at most two indices of the anchor before
/// the change, ascending. A single anchor that is off, between two that agree, is left out.
inline std::vector<std::size_t> jumps_of(const AnchorExplanation& at) {
  constexpr double kLarge = 4.0;  // times the median change
  constexpr std::size_t kMost = 2;
  const auto change = [&](std::size_t i, std::size_t j) {
    return (at.predicted[j].error - at.predicted[i].error).norm();
  };
  std::vector<std::size_t> used;
  for (std::size_t i = 0; i < at.predicted.size(); ++i) {
    if (!at.predicted[i].is_determined) continue;
    const bool is_between = i > 0 && i + 1 < at.predicted.size() && !at.is_kept[i];
    if (is_between && change(i - 1, i + 1) < 0.5 * change(i - 1, i)) continue;
    used.push_back(i);
  }
  std::vector<std::pair<double, std::size_t>> changes;
  std::vector<double> sizes;
  for (std::size_t k = 0; k + 1 < used.size(); ++k) {
    sizes.push_back(change(used[k], used[k + 1]));
    changes.emplace_back(sizes.back(), used[k]);
  }
  if (changes.empty()) return {};
  const double limit = kLarge * upper_median(sizes);
  std::ranges::sort(changes, std::greater{});
  std::vector<std::size_t> out;
  for (const auto& [size, i] : changes) {
    if (size > limit && out.size() < kMost) out.push_back(i);
  }
  std::ranges::sort(out);
  return out;
}

/// The runs that the jumps enclose or cut off: three anchors or more, fewer than half of all.
inline std::vector<AnchorRun> possible_runs(const std::vector<std::size_t>& jumps,
                                            std::size_t anchors) {
  constexpr std::size_t kLeast = 3;
  std::vector<AnchorRun> out;
  const auto add = [&](const AnchorRun& run) {
    const std::size_t count = run.last + 1 - run.first;
    if (count >= kLeast && 2 * count < anchors) out.push_back(run);
  };
  if (jumps.size() == 2) add({jumps[0] + 1, jumps[1]});
  for (const std::size_t each : jumps) {
    add({.first = 0, .last = each, .is_end = true});
    add({.first = each + 1, .last = anchors - 1, .is_end = true});
  }
  return out;
}

/// Mean error of the members of a run that are next to the others, at most three on each side.
inline Eigen::VectorXd shift_of(const AnchorRun& run, const AnchorExplanation& without) {
  constexpr std::size_t kNear = 3;
  const std::size_t end = without.predicted.size();
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(without.predicted[run.first].error.size());
  double count = 0.0;
  for (std::size_t i = run.first; i <= run.last; ++i) {
    const bool is_near =
        (run.first > 0 && i < run.first + kNear) || (run.last + 1 < end && i + kNear > run.last);
    if (!is_near) continue;
    sum += without.predicted[i].error;
    count += 1.0;
  }
  return sum / count;
}

/// Whether a closure checks the odometry between a run at an end and the other anchors.
inline bool is_spanned(const AnchorRun& run, const Problem& problem) {
  const std::size_t before = run.first == 0 ? run.last : run.first - 1;
  if (before + 1 >= problem.anchors.size()) return false;
  const std::size_t begin = problem.anchors[before].keyframe;
  const std::size_t end = problem.anchors[before + 1].keyframe;
  return std::ranges::any_of(
      problem.closures, [&](const Edge& each) { return each.from <= begin && each.to >= end; });
}

inline bool is_mostly_dropped(const AnchorRun& run, const AnchorExplanation& in) {
  std::size_t dropped = 0;
  for (std::size_t i = run.first; i <= run.last; ++i) dropped += in.is_kept[i] ? 0 : 1;
  return 2 * dropped > run.last + 1 - run.first;
}

/// The run whose common shift explains the anchors better than `best`; nullopt: none. The shift has
/// the prior of one outlier that can begin and end anywhere. At most 18 times the solutions of
/// one factor (6 if `is_calibrated`), none if no error changes suddenly.
inline std::optional<ShiftedRun> shifted_run(const Problem& problem,
                                             const AnchorExplanation& best,
                                             bool is_calibrated) {
  constexpr double kLogShift = -3.0;  // as of a wrong step
  const auto count = static_cast<double>(problem.anchors.size());
  double odds = 0.0;
  for (const double each : best.log_odds) odds += std::max(0.0, each) / count;
  double most = best.score + odds - kLogShift + 2.0 * std::log(count);
  std::optional<ShiftedRun> out;
  const AnchorSearch search(problem);
  for (AnchorRun run : possible_runs(jumps_of(best), problem.anchors.size())) {
    std::vector<bool> excluded(problem.anchors.size(), false);
    for (std::size_t i = run.first; i <= run.last; ++i) excluded[i] = true;
    for (const double octaves : {0.0, -2.0, -4.0}) {  // the shift can have widened the odometry
      if (is_calibrated && octaves < 0.0) break;
      const double odometry = best.log_odometry + octaves * std::log(2.0);
      std::optional<AnchorExplanation> without = search.with_odometry(odometry, excluded);
      if (!without) continue;
      const Eigen::VectorXd shift = shift_of(run, *without);
      Problem shifted = problem;
      for (std::size_t i = run.first; i <= run.last; ++i) {
        shifted.anchors[i].position += search.in_world(shift);
      }
      const auto all = AnchorSearch(shifted).with_odometry(odometry);
      if (!all || !(all->score > most)) continue;
      most = all->score;
      run.metres = shift.norm();
      out = {run, std::move(*without)};
    }
  }
  return out;
}

}  // namespace loopbench::methods::consensus

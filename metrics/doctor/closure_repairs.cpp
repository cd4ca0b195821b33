#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "datasets/core/mirrored.hpp"
#include "metrics/doctor/graph_checks.hpp"
#include "metrics/doctor/sampling.hpp"
#include "metrics/doctor/signed_axes.hpp"

namespace loopbench::metrics {
namespace {

/// None reads the odometry, which the result is compared with: such a change would fit any data.
struct EdgeRepair {
  Fault::Name fault = Fault::closure_convention;
  std::string what;
  PoseChange change;
  double penalty = 0.0;  ///< logarithm by which chi-squared has to be less than that of others
};

Pose inverted(const Pose& p) { return p.inverse(); }
Pose unchanged(const Pose& p) { return p; }

/// Direction, order and direction of rotations, axes of the body, left-handed coordinates.
std::vector<EdgeRepair> edge_repairs() {
  constexpr double kUnusual = 0.7, kOneOfMany = 1.4;
  std::vector<EdgeRepair> out{{Fault::closure_direction, "inverting the closures", inverted, 0.0}};
  const auto add = [&](const std::string& what, const PoseChange& change, double penalty) {
    out.push_back({Fault::closure_convention, what, change, penalty});
  };
  const auto rotated = [&](const std::string& what, Rotation (*change)(const Rotation&)) {
    const PoseChange once = [=](const Pose& p) -> Pose {
      return {change(p.rotation), p.translation};
    };
    add(what, once, kUnusual);
    // Readers invert edges that are listed from the later pose.
    add(
        what, [=](const Pose& p) { return once(p.inverse()).inverse(); }, kUnusual);
  };
  rotated("inverting the closures' rotations, but not their translations,",
          [](const Rotation& q) { return Rotation(q.conjugate()); });
  rotated("quaternions of the closures in the order w x y z",
          [](const Rotation& q) { return Rotation(q.x(), q.y(), q.z(), q.w()); });
  rotated("quaternions of the closures, once read as w x y z instead of x y z w,",
          [](const Rotation& q) { return Rotation(q.z(), q.w(), q.x(), q.y()); });
  for (int axis = 0; axis < 3; ++axis) {
    add(
        fmt::format("mirroring {} of the closures", "xyz"[axis]),
        [=](const Pose& p) { return mirrored(p, axis); },
        kOneOfMany);
  }
  for (const auto& [axes, option] : signed_axes()) {
    if (axes.determinant() < 0.0) continue;
    const Rotation body(axes);
    add(
        "taking " + option + " of the closures' body as x,y,z",
        [=](const Pose& p) -> Pose {
          return {body * p.rotation * body.conjugate(), body * p.translation};
        },
        kOneOfMany);
  }
  return out;
}

/// Medians of chi-squared over odometry and over other closures: the first sees frames, the second
/// no drift. Infinite without paths.
struct MedianFit {
  double odometry = 0.0, over_closures = 0.0;

  MedianFit(const std::vector<const LoopPaths*>& loops,
            const Chain& chain,
            const PoseChange& change) {
    std::vector<double> direct, around;
    for (const LoopPaths* loop : loops) {
      direct.push_back(loop->odometry.chi_squared(chain, change));
      if (!loop->over_closures.empty())
        around.push_back(loop->over_closures.front().chi_squared(chain, change));
    }
    odometry = kFileRounding + median_value(std::move(direct));
    over_closures = around.size() < loops.size() / 2
                        ? odometry
                        : kFileRounding + median_value(std::move(around));
  }
  double cost() const { return std::log(odometry) + std::log(over_closures); }
};

/// Whether a change improves the fit to other closures too often for chance. Over odometry, all
/// closures share its drift.
bool are_mostly_better(const std::vector<const LoopPaths*>& loops,
                       const Chain& chain,
                       const PoseChange& change) {
  constexpr double kDeviations = 4.0;  // of the number of better ones
  double better = 0.0, all = 0.0;
  for (const LoopPaths* loop : loops) {
    if (loop->over_closures.empty()) continue;
    const LoopPath& path = loop->over_closures.front();
    better += path.chi_squared(chain, change) < path.chi_squared(chain, unchanged) ? 1.0 : 0.0;
    all += 1.0;
  }
  return 2.0 * better - all > kDeviations * std::sqrt(all);
}

}  // namespace

std::optional<InputFinding> find_closure_repair(const std::vector<LoopPaths>& loops,
                                                const Chain& chain) {
  constexpr std::size_t kHalves = 6;    // from so many on, one half proposes, the other decides
  constexpr std::size_t kMost = 400;    // compared
  constexpr double kMostRatio = 0.3;    // of chi-squared: errors fall to 55 %
  constexpr double kMostOther = 1.2;    // of the other chi-squared; medians of few vary
  constexpr double kRefuted = 4.0;      // chi-squared that the stated noise does not explain
  constexpr double kClearRatio = 0.03;  // if the stated noise is so large that it explains all
  constexpr double kCertain = 12.0;     // closures for which the penalties hold
  constexpr double kHalved = 0.5;       // chi-squared, if nearly all closures agree
  if (loops.size() < kFewestLoops) return std::nullopt;
  std::vector<const LoopPaths*> chosen, tested;
  const std::size_t step = even_step(loops.size(), kMost);
  for (std::size_t i = 0; i < loops.size(); i += step) {
    const bool is_chosen = i / step % 2 == 0;
    if (loops.size() < kHalves || is_chosen) chosen.push_back(&loops[i]);
    if (loops.size() < kHalves || !is_chosen) tested.push_back(&loops[i]);
  }
  const EdgeRepair* best = nullptr;
  double least = MedianFit(chosen, chain, unchanged).cost();
  static const std::vector<EdgeRepair> repairs = edge_repairs();
  const double weight = kCertain / static_cast<double>(loops.size());
  for (const EdgeRepair& repair : repairs) {
    const double cost = MedianFit(chosen, chain, repair.change).cost() + weight * repair.penalty;
    if (!(cost < least)) continue;
    least = cost;
    best = &repair;
  }
  if (best == nullptr) return std::nullopt;
  const MedianFit was(tested, chain, unchanged), is(tested, chain, best->change);
  const double direct = is.odometry / was.odometry, around = is.over_closures / was.over_closures;
  const bool is_direct = direct < around;
  const double ratio = std::min(direct, around),
               before = is_direct ? was.odometry : was.over_closures;
  const bool is_consistent = !is_direct && are_mostly_better(tested, chain, best->change);
  const bool is_refuted = before > kRefuted || ratio < kClearRatio || is_consistent;
  if (ratio > (is_consistent ? kHalved : kMostRatio) || std::max(direct, around) > kMostOther ||
      !is_refuted)
    return std::nullopt;
  return InputFinding{
      best->fault,
      fmt::format("{}: median chi-squared of {} closures per degree of freedom, as {} predicts "
                  "them, {:.3g} -> {:.3g}",
                  best->what,
                  tested.size(),
                  is_direct ? "the odometry" : "one another",
                  before,
                  ratio * before),
      best->fault == Fault::closure_direction
          ? "exchange the two vertices of each closure (or of each odometry edge)"
          : "write the closures in right-handed axes of the odometry's body, quaternions as x y z "
            "w",
      1.0 - std::sqrt(ratio),
      static_cast<double>(loops.size())};
}

}  // namespace loopbench::metrics

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "metrics/doctor/graph_checks.hpp"
#include "metrics/doctor/sampling.hpp"

namespace loopbench::metrics {
namespace {

constexpr std::string_view kDirection = "--invert-poses";

/// None reads the odometry, which the result is compared with: such a change would fit any data.
std::vector<Convention> closure_conventions() {
  std::vector<Convention> out;
  for (const Convention& each : conventions(true)) {
    out.push_back(each);
    if (each.fault == Fault::axes || each.fault == Fault::mirrored) continue;
    // Readers invert edges that are listed from the later pose.
    out.push_back(each);
    out.back().change = [=](const Pose& p) { return each.change(p.inverse()).inverse(); };
  }
  return out;
}

double gain(const MedianFit& before, const MedianFit& after) {
  return std::log(before.odometry / after.odometry) +
         std::log(before.over_closures / after.over_closures);
}

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
    better += path.chi_squared(chain, change) < path.chi_squared(chain, as_stated) ? 1.0 : 0.0;
    all += 1.0;
  }
  return 2.0 * better - all > kDeviations * std::sqrt(all);
}

}  // namespace

std::optional<InputFinding> find_closure_repair(const std::vector<LoopPaths>& loops,
                                                const Chain& chain) {
  // Gain by which conventions have to exceed the direction, and closures that lower it.
  constexpr double kMostPenalty = 1.4, kCertain = 8.0;
  constexpr double kMostPart = 0.3;     // of chi-squared: errors fall to 55 %
  constexpr double kMostOther = 1.2;    // of the other chi-squared; medians of few vary
  constexpr double kHalved = 0.5;       // chi-squared, if nearly all closures agree
  constexpr double kRefuted = 4.0;      // chi-squared that the stated noise does not explain
  constexpr double kClearRatio = 0.03;  // if the stated noise is so large that it explains all
  if (loops.size() < kFewestLoops) return std::nullopt;
  std::vector<const LoopPaths*> chosen, tested;
  // One half proposes, the other decides.
  const bool has_halves = loops.size() >= 2 * kFewestLoops;
  const std::size_t step = even_step(loops.size(), kMostPoses);
  for (std::size_t i = 0; i < loops.size(); i += step) {
    const bool is_chosen = i / step % 2 == 0;
    if (!has_halves || is_chosen) chosen.push_back(&loops[i]);
    if (!has_halves || !is_chosen) tested.push_back(&loops[i]);
  }
  static const std::vector<Convention> all = closure_conventions();
  const MedianFit as_read(chosen, chain, as_stated), was(tested, chain, as_stated);
  const double unit = std::min(kMostPenalty, kCertain / static_cast<double>(loops.size()));
  const Convention* best = nullptr;
  double largest = 0.0;
  for (const Convention& each : all) {
    // Axes are one of many conventions.
    const double of_axes = each.unusual > 1.0 ? 2.0 * unit : unit;
    const double penalty = each.option == kDirection ? 0.0 : of_axes;
    const double gained = gain(as_read, MedianFit(chosen, chain, each.change)) - penalty;
    if (!(gained > largest)) continue;
    largest = gained;
    best = &each;
  }
  if (best == nullptr) return std::nullopt;
  const MedianFit is(tested, chain, best->change);
  const double direct = is.odometry / was.odometry, around = is.over_closures / was.over_closures;
  const bool is_direct = direct < around;
  const double ratio = std::min(direct, around);
  const double before = is_direct ? was.odometry : was.over_closures;
  const bool is_consistent = !is_direct && are_mostly_better(tested, chain, best->change);
  const bool is_refuted = before > kRefuted || ratio < kClearRatio || is_consistent;
  if (ratio > (is_consistent ? kHalved : kMostPart) || std::max(direct, around) > kMostOther ||
      !is_refuted)
    return std::nullopt;
  const bool is_direction = best->option == kDirection;
  return InputFinding{is_direction ? Fault::closure_direction : Fault::closure_convention,
                      fmt::format("{} of the closures: their median chi-squared per degree of "
                                  "freedom, as {} "
                                  "predicts {} of them, {:.3g} -> {:.3g}",
                                  best->what,
                                  is_direct ? "the odometry" : "one another",
                                  tested.size(),
                                  before,
                                  ratio * before),
                      is_direction ? "exchange the two vertices of each closure (or of each "
                                     "odometry edge)"
                                   : "write the closures in right-handed axes of the "
                                     "odometry's body, quaternions "
                                     "as x y z w",
                      1.0 - std::sqrt(ratio),
                      static_cast<double>(loops.size())};
}

}  // namespace loopbench::metrics

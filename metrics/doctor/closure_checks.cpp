#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "metrics/doctor/graph_checks.hpp"
#include "metrics/doctor/sampling.hpp"

namespace loopbench::metrics {
namespace {

constexpr double kMost = 36.0;        // chi-squared: six standard deviations
constexpr double kMostDrift = 0.35;   // of the length of a loop; odometry is better
constexpr double kUsualDrift = 0.01;  // the same, which stated noise can neglect

Pose as_stated(const Pose& p) { return p; }

double gap_of(const LoopPath& path, const Chain& chain) {
  return path.residual(chain, as_stated).head<3>().norm();
}

/// Chi-squared over odometry, and the middle one over three closures, of which a false one is
/// outvoted.
struct CheckedClosure {
  const LoopPaths* paths = nullptr;
  double odometry = 0.0, over_closures = 0.0;
  double excess = 0.0;  ///< of the larger one over its limit; 1: contradicted
  bool is_gross = false;
};

/// Removes closures that state exactly the identity, as if a place recogniser had measured no
/// relative poses, if they are at least a fifth and neither the odometry nor a neighbour that
/// states the same agrees. O(closures).
std::optional<InputFinding> remove_placeholders(std::vector<Edge>& closures, const Chain& chain) {
  constexpr double kLeastPart = 0.2;
  constexpr double kLeastGap = 0.05, kOfLength = 0.02;  // [m]; drift of most odometry [-]
  std::vector<Edge> identities, measured;
  for (const Edge& edge : closures) {
    const Pose& stated = edge.from_from_to;
    const bool is_identity =
        stated.rotation.vec().norm() < kFileRounding && stated.translation.norm() < kFileRounding;
    (is_identity ? identities : measured).push_back(edge);
  }
  const std::size_t count = identities.size(), all = closures.size();
  if (count < 2 || static_cast<double>(count) < kLeastPart * static_cast<double>(all))
    return std::nullopt;
  std::vector<double> gaps, over_drift;
  for (const LoopPaths& each : loop_paths(identities, chain)) {
    const auto& [from, to, pose, information, scale] = *each.odometry.closure;
    gaps.push_back(gap_of(each.odometry, chain));
    // Steady motion makes neighbours agree, but not with the odometry.
    over_drift.push_back(gaps.back() / (kMostDrift * chain.distance(from, to)));
    for (const LoopPath& path : each.over_closures) {
      const double length =
          chain.distance(from, path.over->from) + chain.distance(to, path.over->to);
      over_drift.back() =
          std::max(over_drift.back(), gap_of(path, chain) / (kLeastGap + kOfLength * length));
    }
  }
  const double gap = median_value(std::move(gaps));
  if (median_value(std::move(over_drift)) < 1.0 || gap < kLeastGap) return std::nullopt;
  closures = std::move(measured);
  return InputFinding{
      Fault::placeholders,
      fmt::format("{} of {} closures state exactly the same pose at both ends, where the odometry "
                  "has a median distance of {:.3g} m: it was not measured",
                  count,
                  all,
                  gap),
      "measure the relative poses (registration)",
      0.7,
      static_cast<double>(count)};
}

/// Closures whose chi-squared is 36 times the median and the one expected. Of less than four, whose
/// median shows nothing, the gap also has to exceed 35 % of the loop's length. O(closures).
std::vector<CheckedClosure> contradicted_closures(const std::vector<LoopPaths>& loops,
                                                  const Chain& chain) {
  constexpr double kLeastGap = 0.3;  // [m] or [rad]: smaller ones do little harm
  constexpr std::size_t kFewest = 4;
  std::vector<CheckedClosure> all, out;
  std::vector<double> odometry, over_closures;
  for (const LoopPaths& each : loops) {
    CheckedClosure& closure = all.emplace_back();
    closure.paths = &each;
    closure.odometry = each.odometry.chi_squared(chain, as_stated);
    odometry.push_back(closure.odometry);
    if (each.over_closures.size() < kFewestLoops || loops.size() < kFewest) continue;
    std::vector<double> votes;
    for (const LoopPath& path : each.over_closures)
      votes.push_back(path.chi_squared(chain, as_stated));
    closure.over_closures = median_value(std::move(votes));
    over_closures.push_back(closure.over_closures);
  }
  const double usual = std::max(1.0, median_value(std::move(odometry)));
  const double usual_over = std::max(1.0, median_value(std::move(over_closures)));
  for (CheckedClosure& each : all) {
    const Twist residual = each.paths->odometry.residual(chain, as_stated);
    const Edge& edge = *each.paths->odometry.closure;
    const double gap = residual.head<3>().norm();
    const double distance = chain.distance(edge.from, edge.to);
    const bool is_small = std::max(gap, residual.tail<3>().norm()) < kLeastGap;
    const bool is_usual = gap < kUsualDrift * distance;
    // Most closures can be false; then the usual chi-squared shows nothing.
    each.is_gross = gap > kMostDrift * distance && each.odometry > kMost &&
                    (each.over_closures == 0.0 || each.over_closures > kMost);
    const double relative =
        std::max(is_usual ? 0.0 : each.odometry / usual, each.over_closures / usual_over);
    each.excess = std::sqrt((each.is_gross ? std::max(relative, each.odometry) : relative) / kMost);
    const bool is_drift = loops.size() < kFewest && !each.is_gross;
    if (each.excess > 1.0 && !is_small && !is_drift) out.push_back(each);
  }
  std::ranges::stable_sort(out, std::greater{}, &CheckedClosure::excess);
  return out;
}

InputFinding contradiction(const std::vector<CheckedClosure>& found,
                           std::size_t all,
                           const Chain& chain,
                           const Problem& problem) {
  std::string list;
  for (std::size_t i = 0; i < std::min(kListed, found.size()); ++i) {
    const LoopPath& path = found[i].paths->odometry;
    const auto& [from, to, pose, information, scale] = *path.closure;
    list += fmt::format("{}{} -> {} (gap of {:.3g} m after {:.3g} m)",
                        i == 0 ? "" : ", ",
                        problem.name_of(from),
                        problem.name_of(to),
                        gap_of(path, chain),
                        chain.distance(from, to));
  }
  return {Fault::closure_gap,
          fmt::format("{} of {} closures contradict the odometry or other closures with the stated "
                      "covariances, most of all {}",
                      found.size(),
                      all,
                      list),
          "check them; robust methods are made for false closures",
          1.0 - 1.0 / std::max(2.0, found.front().excess),
          static_cast<double>(found.size())};
}

/// The median chi-squared over the most certain paths. O(closures).
std::optional<InputFinding> check_information(const std::vector<LoopPaths>& loops,
                                              const Chain& chain) {
  constexpr double kTooLarge = 100.0, kTooSmall = 1e-4;  // drift exceeds noise
  std::vector<double> direct, around, gaps;
  for (const LoopPaths& each : loops) {
    direct.push_back(each.odometry.chi_squared(chain, as_stated));
    if (!each.over_closures.empty())
      around.push_back(each.over_closures.front().chi_squared(chain, as_stated));
    gaps.push_back(each.odometry.residual(chain, as_stated).norm());
  }
  double found = median_value(std::move(direct));
  const bool has_neighbours = around.size() >= kFewestLoops;
  const double of_neighbours = median_value(std::move(around));
  // One step of the odometry with a large deviation makes all direct paths certain of nothing.
  if (has_neighbours && std::min(found, of_neighbours) < kTooSmall) found = of_neighbours;
  if (loops.size() < kFewestLoops || (found < kTooLarge && found > kTooSmall) ||
      median_value(std::move(gaps)) < kNoNoise) {
    return std::nullopt;
  }
  return InputFinding{
      Fault::information,
      fmt::format("the gaps of {} loops have a median chi-squared of {:.2g} per degree of freedom, "
                  "expected 1: their variances are {:.2g} times those stated",
                  loops.size(),
                  found,
                  found),
      "check the information of the edges; for a trajectory: options odometry.sigma_*, "
      "closures.sigma_*",
      0.8,
      found};
}

}  // namespace

std::vector<InputFinding> check_closures(const Problem& problem) {
  std::vector<InputFinding> out;
  const bool is_chain = problem.odometry.size() + 1 == problem.keyframes.size();
  if (problem.closures.empty() || !is_chain) return out;
  std::vector<Edge> closures = problem.closures;
  const Chain chain = chain_of(problem);
  if (auto found = remove_placeholders(closures, chain)) out.push_back(*found);
  const std::vector<LoopPaths> loops = loop_paths(closures, chain);
  if (auto repair = find_closure_repair(loops, chain)) {
    out.push_back(std::move(*repair));
    return out;
  }
  std::vector<CheckedClosure> found = contradicted_closures(loops, chain);
  std::optional<InputFinding> information;
  if (3 * found.size() < loops.size()) {  // more false closures would show no information
    std::vector<LoopPaths> others;
    for (const LoopPaths& each : loops) {
      if (std::ranges::count(found, &each, &CheckedClosure::paths) == 0) others.push_back(each);
    }
    information = check_information(others, chain);
  }
  if (information) {
    const double most = kMost * information->value;
    std::erase_if(found, [&](const CheckedClosure& each) {
      return !each.is_gross || std::max(each.odometry, each.over_closures) < most;
    });
  }
  if (!found.empty()) out.push_back(contradiction(found, loops.size(), chain, problem));
  if (information) out.push_back(std::move(*information));
  return out;
}

}  // namespace loopbench::metrics

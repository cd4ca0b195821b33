#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "metrics/doctor/graph_checks.hpp"
#include "metrics/doctor/judged_problem.hpp"
#include "metrics/doctor/sampling.hpp"

namespace loopbench::metrics {
namespace {

constexpr double kMost = 36.0;       // chi-squared: six standard deviations
constexpr double kMostDrift = 0.35;  // of the length of a loop; odometry is better

/// Distance between the positions of the closure's end by itself and by the path [m].
double gap_of(const LoopPath& path, const Chain& chain) {
  return exp_se3(path.residual(chain, as_stated)).translation.norm();
}

/// Chi-squared over odometry, and the middle one over three closures, of which a false one is
/// outvoted.
struct CheckedClosure {
  const LoopPaths* paths = nullptr;
  double odometry = 0.0, over_closures = 0.0;
  double excess = 0.0;  ///< over what contradicts
  bool is_gross = false;
};

/// Removes closures that state exactly the identity, as if a place recogniser had measured no
/// relative poses, if they are at least a fifth and the odometry or other closures contradict most.
/// O(closures).
std::optional<InputFinding> remove_placeholders(std::vector<Edge>& closures, const Chain& chain) {
  constexpr double kLeastPart = 0.2, kLeastGap = 0.05, kUsualDrift = 0.02;  // [-], [m], [-]
  std::vector<Edge> identities, measured;
  for (const Edge& edge : closures) {
    const bool is_identity = is_close(edge.from_from_to, Pose{}, kFileRounding, kFileRounding);
    (is_identity ? identities : measured).push_back(edge);
  }
  const std::size_t count = identities.size(), all = closures.size();
  if (count < 2 || static_cast<double>(count) < kLeastPart * static_cast<double>(all))
    return std::nullopt;
  std::vector<double> gaps, over_drift;
  for (const LoopPaths& each : loop_paths(identities, chain)) {
    const std::size_t from = each.odometry.closure->from, to = each.odometry.closure->to;
    gaps.push_back(gap_of(each.odometry, chain));
    over_drift.push_back(gaps.back() / (kMostDrift * chain.distance(from, to)));
    // Steady motion makes neighbours agree, but not with the odometry.
    for (const LoopPath& path : each.over_closures) {
      const double length =
          chain.distance(from, path.over->from) + chain.distance(to, path.over->to);
      over_drift.back() =
          std::max(over_drift.back(), gap_of(path, chain) / (kLeastGap + kUsualDrift * length));
    }
  }
  if (median_value(std::move(over_drift)) < 1.0) return std::nullopt;
  closures = std::move(measured);
  return InputFinding{Fault::placeholders,
                      fmt::format("{} of {} closures state exactly the same pose at both ends, "
                                  "where the odometry has a median distance of {:.3g} m: it was "
                                  "not measured",
                                  count,
                                  all,
                                  median_value(std::move(gaps))),
                      "measure the relative poses (registration)",
                      0.7,
                      static_cast<double>(count)};
}

/// Closures whose chi-squared is 36 times the median and the one expected. Of less than four, whose
/// median shows nothing, the gap also has to exceed 35 % of the loop's length. O(closures).
std::vector<CheckedClosure> contradicted_closures(const std::vector<LoopPaths>& loops,
                                                  const Chain& chain) {
  constexpr double kLeastGap = 0.3;  // [m] or [rad]: smaller ones do little harm
  std::vector<CheckedClosure> all, out;
  std::vector<double> odometry, over_closures;
  for (const LoopPaths& each : loops) {
    all.push_back({&each, each.odometry.chi_squared(chain, as_stated)});
    odometry.push_back(all.back().odometry);
    if (each.over_closures.size() < kFewestLoops) continue;
    std::vector<double> votes;
    for (const LoopPath& path : each.over_closures)
      votes.push_back(path.chi_squared(chain, as_stated));
    all.back().over_closures = median_value(std::move(votes));
    over_closures.push_back(all.back().over_closures);
  }
  const double usual = std::max(1.0, median_value(std::move(odometry)));
  const double usual_over = std::max(1.0, median_value(std::move(over_closures)));
  for (CheckedClosure& each : all) {
    const LoopPath& path = each.paths->odometry;
    const double gap = gap_of(path, chain);
    if (std::max(gap, path.residual(chain, as_stated).tail<3>().norm()) < kLeastGap) continue;
    // Most closures can be false; then the usual chi-squared shows nothing.
    each.is_gross = gap > kMostDrift * chain.distance(path.closure->from, path.closure->to) &&
                    each.odometry > kMost &&
                    (each.over_closures == 0.0 || each.over_closures > kMost);
    double excess = each.is_gross ? each.odometry : 0.0;
    if (loops.size() > kFewestLoops)
      excess = std::max({excess, each.odometry / usual, each.over_closures / usual_over});
    each.excess = std::sqrt(excess / kMost);
    if (each.excess > 1.0) out.push_back(each);
  }
  std::ranges::stable_sort(out, std::greater{}, &CheckedClosure::excess);
  return out;
}

InputFinding contradiction(const std::vector<CheckedClosure>& found,
                           std::size_t all,
                           const Chain& chain,
                           const Problem& problem) {
  std::vector<std::string> list;
  for (std::size_t i = 0; i < std::min(kListed, found.size()); ++i) {
    const LoopPath& path = found[i].paths->odometry;
    const std::size_t from = path.closure->from, to = path.closure->to;
    list.push_back(fmt::format("{} -> {} (gap of {:.3g} m after {:.3g} m)",
                               problem.name_of(from),
                               problem.name_of(to),
                               gap_of(path, chain),
                               chain.distance(from, to)));
  }
  return {Fault::closure_gap,
          fmt::format("{} of {} closures contradict the odometry or other "
                      "closures with the stated "
                      "covariances, most of all {}",
                      found.size(),
                      all,
                      fmt::join(list, ", ")),
          "check them; robust methods are made for false closures",
          1.0 - 1.0 / std::max(2.0, found.front().excess),
          static_cast<double>(found.size())};
}

/// Whether a closure measures some axes only, as one of yaw. Over another such closure, any tilt
/// makes all axes as uncertain as the open ones.
bool leaves_axes_open(const Edge& closure) {
  constexpr double kOpen = 1e-8;  // of the largest information
  const Eigen::SelfAdjointEigenSolver<Matrix6> axes(closure.information, Eigen::EigenvaluesOnly);
  const Twist& values = axes.eigenvalues();
  return values.minCoeff() < kOpen * values.maxCoeff();
}

/// The median chi-squared over the most certain paths. O(closures).
std::optional<InputFinding> check_information(const std::vector<const LoopPaths*>& loops,
                                              const Chain& chain) {
  constexpr double kTooLarge = 100.0, kTooSmall = 1e-4;  // drift exceeds noise
  if (loops.size() < kFewestLoops) return std::nullopt;
  const MedianFit fit(loops, chain, as_stated);
  // One step of the odometry with a large deviation makes all direct paths certain of nothing.
  const double found =
      std::min(fit.odometry, fit.over_closures) < kTooSmall ? fit.over_closures : fit.odometry;
  std::vector<double> gaps;
  for (const LoopPaths* each : loops) gaps.push_back(gap_of(each->odometry, chain));
  const bool is_exact = median_value(std::move(gaps)) < kNoNoise;
  const auto open = std::ranges::count_if(
      loops, [](const LoopPaths* each) { return leaves_axes_open(*each->odometry.closure); });
  const bool is_small = found < kTooSmall && 2 * open < std::ssize(loops);
  if (is_exact || (found < kTooLarge && !is_small)) return std::nullopt;
  return InputFinding{Fault::information,
                      fmt::format("the gaps of {} loops have a median chi-squared of {:.2g} "
                                  "per degree of freedom, "
                                  "expected 1: their variances are {:.2g} times those stated",
                                  loops.size(),
                                  found,
                                  found),
                      "check the information of the edges; for a trajectory: options "
                      "odometry.sigma_*, "
                      "closures.sigma_*",
                      0.8,
                      found};
}

/// Closures that are not judged, because edges have scales, or that do not decide.
std::vector<InputFinding> check_by_medians(const std::vector<LoopPaths>& loops,
                                           const Chain& chain,
                                           const Problem& problem) {
  std::vector<InputFinding> out;
  std::vector<CheckedClosure> found = contradicted_closures(loops, chain);
  std::optional<InputFinding> information;
  // More false closures would show no information.
  if (3 * found.size() < loops.size()) {
    std::vector<const LoopPaths*> others;
    for (const LoopPaths& each : loops) {
      if (std::ranges::count(found, &each, &CheckedClosure::paths) == 0) others.push_back(&each);
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

}  // namespace

std::vector<InputFinding> check_closures(const Problem& problem,
                                         const methods::ClosureJudgement* known) {
  std::vector<InputFinding> out;
  if (problem.closures.empty()) return out;
  if (const auto found = check_edge_frames(problem)) return {*found};
  std::vector<Edge> closures = problem.closures;  // without those found before
  JudgedProblem judged(problem, known);
  const bool is_chain = problem.odometry.size() + 1 == problem.keyframes.size();
  if (!is_chain) return judged.findings();
  const Chain chain = chain_of(problem);
  if (!judged.is_as_stated()) {
    if (auto found = remove_placeholders(closures, chain)) {
      out.push_back(*found);
      Problem rest = problem;
      rest.closures = closures;
      judged = JudgedProblem(std::move(rest), nullptr);
    }
    const std::vector<LoopPaths> loops = loop_paths(closures, chain);
    const auto repair = find_closure_repair(loops, chain);
    // Over odometry with scales, rotations alone are compared: half as much evidence.
    const std::size_t fewest = chain.has_scale ? 2 * kFewestLoops : kFewestLoops;
    if (repair) {
      if (loops.size() >= fewest) out.push_back(*repair);
      return out;
    }
    if (!judged.is_decided()) {
      std::ranges::move(check_by_medians(loops, chain, problem), std::back_inserter(out));
      return out;
    }
  }
  std::ranges::move(judged.findings(), std::back_inserter(out));
  return out;
}

}  // namespace loopbench::metrics

#include "metrics/doctor/closure_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "metrics/doctor/closure_chain.hpp"
#include "metrics/doctor/common_motion.hpp"
#include "metrics/doctor/information_checks.hpp"

namespace loopbench::metrics {
namespace {

InputFinding inverted_closures(std::string evidence, double confidence, std::size_t inverted) {
  return {Fault::closure_direction,
          std::move(evidence),
          "exchange FROM and TO of the closures, or invert their poses",
          confidence,
          static_cast<double>(inverted)};
}

/// For closures without neighbours: an inversion shows where the drift is small against it.
std::vector<InputFinding> check_direction_of_few(const std::vector<Edge>& closures,
                                                 const Chain& chain) {
  constexpr double kLikelier = 4.5;
  std::vector<double> as_read, inverted, smaller;
  std::size_t better = 0;
  for (const Edge& edge : closures) {
    as_read.push_back(closure_error(edge, chain, false, false).whole);
    inverted.push_back(closure_error(edge, chain, false, true).whole);
    smaller.push_back(std::min(as_read.back(), inverted.back()));
    better += inverted.back() < as_read.back() ? 1 : 0;
  }
  // Logarithm of the ratio of likelihoods, of heavy-tailed errors in six dimensions a closure. The
  // stated covariance can be wrong by a factor.
  const double size = std::max(1e-12, median_value(smaller));
  double likelier = 0.0;
  for (std::size_t i = 0; i < closures.size(); ++i) {
    likelier += 3.0 * std::log((size + as_read[i]) / (size + inverted[i]));
  }
  if (2 * better <= closures.size() || likelier < kLikelier) return {};
  return {inverted_closures(
      fmt::format("{} of {} closures fit the odometry better after inversion (logarithm of the "
                  "ratio of likelihoods {:.1f})",
                  better,
                  closures.size(),
                  likelier),
      1.0 - std::exp(-0.25 * likelier),
      better)};
}

std::vector<InputFinding> check_direction(const std::vector<Edge>& closures,
                                          const std::vector<Neighbours>& neighbours,
                                          const Chain& chain) {
  constexpr double kBetter = 0.5;
  constexpr std::size_t kFewest = 3;
  if (neighbours.size() < kFewest) return check_direction_of_few(closures, chain);
  const auto median_of = [&](bool inverted, bool of_rotation) {
    std::vector<double> norms;
    for (const Neighbours& pair : neighbours) {
      const Twist residual = neighbour_residual(pair, chain, inverted);
      norms.push_back(of_rotation ? residual.tail<3>().norm() : residual.head<3>().norm());
    }
    return median_value(std::move(norms));
  };
  const double translation = median_of(false, false);
  const double translation_inverted = median_of(true, false);
  const double rotation = median_of(false, true);
  const double rotation_inverted = median_of(true, true);
  const bool is_inverted =
      translation_inverted < kBetter * translation && rotation_inverted < 1.2 * rotation + 1e-9;
  if (!is_inverted) return {};
  return {inverted_closures(
      fmt::format("neighbouring closures differ by {:.3g} m (median of {} pairs), after "
                  "inversion by {:.3g} m",
                  translation,
                  neighbours.size(),
                  translation_inverted),
      1.0 - translation_inverted / translation,
      closures.size())};
}

/// Limit of a gap over the length of its loop: eight times the drift of most loops.
double most_drift(const std::vector<Edge>& closures, const Chain& chain) {
  constexpr double kMost = 0.35, kOverUsual = 8.0;
  constexpr std::size_t kFewest = 4;
  if (closures.size() < kFewest) return kMost;
  std::vector<double> drifts;
  for (const Edge& edge : closures) {
    const Pose gap = edge.from_from_to.inverse() * chain.between(edge.from, edge.to);
    drifts.push_back(gap.translation.norm() / std::max(1.0, chain.length(edge.from, edge.to)));
  }
  return std::min(kMost, kOverUsual * median_value(std::move(drifts)));
}

/// Limit of the squared error over its variance: fifty times that of nine in ten closures.
double most_error(const std::vector<Edge>& closures, const Chain& chain) {
  constexpr double kOverUsual = 50.0;
  constexpr std::size_t kFewest = 4;
  if (closures.size() < kFewest) return std::numeric_limits<double>::infinity();
  std::vector<double> errors;
  for (const Edge& edge : closures) {
    errors.push_back(closure_error(edge, chain, false, false).whole);
  }
  const std::size_t nine_in_ten = 9 * (errors.size() - 1) / 10;
  std::ranges::nth_element(errors, errors.begin() + static_cast<std::ptrdiff_t>(nine_in_ten));
  return kOverUsual * errors[nine_in_ten];
}

std::vector<InputFinding> check_gaps(const std::vector<Edge>& closures, const Chain& chain) {
  constexpr double kLeast = 2.0;  // [m]
  const double drift = most_drift(closures, chain);
  const double error = most_error(closures, chain);
  std::size_t implausible = 0;
  double plausible_squares = 0.0, squares = 0.0;  // of the gaps [m^2]
  const Edge* worst = nullptr;
  double largest = 0.0;  // over its limit
  for (const Edge& edge : closures) {
    const Pose gap = edge.from_from_to.inverse() * chain.between(edge.from, edge.to);
    const double distance = gap.translation.norm();
    squares += distance * distance;
    const double over = std::max(distance / (kLeast + drift * chain.length(edge.from, edge.to)),
                                 closure_error(edge, chain, false, false).whole / error);
    if (distance <= kLeast || !(over > 1.0)) {
      plausible_squares += distance * distance;
      continue;
    }
    ++implausible;
    if (over <= largest) continue;
    largest = over;
    worst = &edge;
  }
  if (worst == nullptr) return {};
  const std::size_t plausible = std::max<std::size_t>(1, closures.size() - implausible);
  const double rms_before = std::sqrt(squares / static_cast<double>(closures.size()));
  const double rms_after = std::sqrt(plausible_squares / static_cast<double>(plausible));
  return {{Fault::closure_gap,
           fmt::format("{} of {} closures contradict the odometry, most of all {} -> {}: the gap "
                       "is {:.3g} m after {:.3g} m",
                       implausible,
                       closures.size(),
                       worst->from,
                       worst->to,
                       (worst->from_from_to.inverse() * chain.between(worst->from, worst->to))
                           .translation.norm(),
                       chain.length(worst->from, worst->to)),
           "remove false closures, or use a robust method",
           1.0 - rms_after / rms_before,
           static_cast<double>(implausible)}};
}

}  // namespace

std::vector<InputFinding> check_closures(const Problem& problem) {
  std::vector<InputFinding> out;
  const bool is_chain = problem.odometry.size() + 1 == problem.keyframes.size();
  if (problem.closures.empty() || !is_chain) return out;
  const Chain chain = chain_of(problem, false);
  const std::vector<Neighbours> neighbours = neighbours_of(problem.closures, chain);
  out = check_direction(problem.closures, neighbours, chain);
  if (!out.empty()) return out;
  for (const auto& found : {check_gaps(problem.closures, chain),
                            check_information(problem.closures, chain, chain_of(problem, true))}) {
    out.insert(out.end(), found.begin(), found.end());
  }
  return out;
}

}  // namespace loopbench::metrics

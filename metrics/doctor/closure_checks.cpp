#include "metrics/doctor/closure_checks.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "metrics/doctor/closure_chain.hpp"
#include "metrics/doctor/closure_gaps.hpp"
#include "metrics/doctor/common_motion.hpp"
#include "metrics/doctor/finding.hpp"
#include "metrics/doctor/information_checks.hpp"
#include "metrics/doctor/loop_likelihood.hpp"

namespace loopbench::metrics {
namespace {

/// The closure of a pair that states the larger covariance.
const Edge* less_certain(const Neighbours& pair) {
  return pair.a->information.trace() < pair.b->information.trace() ? pair.a : pair.b;
}

/// Stated standard deviation of the translation [m].
double stated_deviation(const Edge& edge) {
  const Matrix6 covariance = edge.information.inverse();
  return std::sqrt(covariance.topLeftCorner<3, 3>().trace());
}

/// Compares each pair of neighbouring closures with its covariance (`errors`, one for each pair). A
/// finding if pairs agree ten thousand times better than most: a squared error over its variance
/// below 1e-4 of the median and 1e-5, which has a probability below 1e-7 in three dimensions.
/// Copies of a closure do not count. Too small a covariance of single closures has no effect on
/// these pairs, because the other closure explains their difference. O(pairs).
std::vector<InputFinding> check_edges(const std::vector<Edge>& closures,
                                      const std::vector<Neighbours>& neighbours,
                                      const std::vector<SquaredError>& errors) {
  constexpr double kMost = 1e-5, kOfMedian = 1e-4, kCopy = 1e-20;
  std::vector<double> all;
  for (const SquaredError& error : errors) {
    if (error.whole > kCopy) all.push_back(error.whole);
  }
  const double usual = median_value(all);
  const double limit = std::min(kMost, kOfMedian * usual);
  std::set<std::size_t> found;
  const Edge* worst = nullptr;
  double least = limit;
  std::vector<double> ratios;  // of the usual error to theirs
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (!(errors[i].whole > kCopy) || errors[i].whole > limit) continue;
    found.insert(static_cast<std::size_t>(less_certain(neighbours[i]) - closures.data()));
    ratios.push_back(usual / errors[i].whole);
    if (errors[i].whole > least) continue;
    least = errors[i].whole;
    worst = less_certain(neighbours[i]);
  }
  if (worst == nullptr) return {};
  const double factor = median_value(std::move(ratios));
  return {
      {Fault::edge_covariance,
       fmt::format("{} of {} closures agree with their neighbours much better than they state, "
                   "most of all {} -> {}: standard deviation {:.3g} m, squared error over its "
                   "variance {:.2g}, median {:.2g}",
                   found.size(),
                   closures.size(),
                   worst->from,
                   worst->to,
                   stated_deviation(*worst),
                   least,
                   usual),
       fmt::format("check their information, which would fit after multiplication by {:.1g}, the "
                   "median of the ratios to the usual error",
                   factor),
       1.0 - std::sqrt(least / usual),
       static_cast<double>(found.size())}};
}

InputFinding inverted_closures(std::string evidence, double confidence, std::size_t inverted) {
  return {Fault::closure_direction,
          std::move(evidence),
          "exchange the two vertices of each closure; in a file of loops the first two columns",
          confidence,
          static_cast<double>(inverted)};
}

/// For closures without neighbours: an inversion shows where the drift is small against it.
std::vector<InputFinding> check_direction_of_few(const Problem& problem, const Chain& chain) {
  constexpr double kLikelier = 5.0;
  constexpr std::size_t kMostClosures = 12;  // that are compared
  const std::size_t step = (problem.closures.size() - 1) / kMostClosures + 1;
  std::vector<Edge> closures;
  for (std::size_t i = 0; i < problem.closures.size(); i += step) {
    closures.push_back(problem.closures[i]);
  }
  const double likelier = inversion_log_ratio(closures, chain);
  if (!(likelier > kLikelier)) return {};
  return {inverted_closures(
      fmt::format("{} closures fit the odometry better after inversion (logarithm of the ratio of "
                  "likelihoods {:.1f})",
                  closures.size(),
                  likelier),
      1.0 - std::exp(-0.25 * likelier),
      problem.closures.size())};
}

std::vector<InputFinding> check_direction(const Problem& problem,
                                          const std::vector<Neighbours>& neighbours,
                                          const Chain& chain) {
  constexpr double kBetter = 0.5;
  constexpr std::size_t kFewest = 3;
  if (neighbours.size() < kFewest) return check_direction_of_few(problem, chain);
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
      problem.closures.size())};
}

}  // namespace

std::vector<InputFinding> check_closures(const Problem& problem) {
  std::vector<InputFinding> out;
  const bool is_chain = problem.odometry.size() + 1 == problem.keyframes.size();
  if (problem.closures.empty() || !is_chain) return out;
  const Chain chain = chain_of(problem);
  const std::vector<Neighbours> neighbours = neighbours_of(problem.closures, chain);
  out = check_direction(problem, neighbours, chain);
  if (!out.empty()) return out;
  std::vector<SquaredError> errors;
  for (const Edge& edge : problem.closures) errors.push_back(closure_error(edge, chain, false));
  const std::vector<SquaredError> of_pairs = neighbour_errors(neighbours, chain);
  for (const auto& found : {check_gaps(problem, chain, errors),
                            check_information(problem.closures, errors, of_pairs, chain),
                            check_edges(problem.closures, neighbours, of_pairs)}) {
    out.insert(out.end(), found.begin(), found.end());
  }
  return out;
}

}  // namespace loopbench::metrics

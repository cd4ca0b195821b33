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
#include "metrics/doctor/closure_repairs.hpp"
#include "metrics/doctor/common_motion.hpp"
#include "metrics/doctor/finding.hpp"
#include "metrics/doctor/information_checks.hpp"

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

}  // namespace

std::vector<InputFinding> check_closures(const Problem& problem) {
  std::vector<InputFinding> out;
  const bool is_chain = problem.odometry.size() + 1 == problem.keyframes.size();
  if (problem.closures.empty() || !is_chain) return out;
  const Chain chain = chain_of(problem);
  if (auto repair = find_odometry_repair(problem)) return {*repair};
  if (auto repair = find_closure_repair(problem, chain)) return {*repair};
  std::vector<SquaredError> errors;
  for (const Edge& edge : problem.closures) errors.push_back(closure_error(edge, chain, false));
  const GapCheck gaps = check_gaps(problem, chain, errors);
  if (gaps.finding) out.push_back(*gaps.finding);
  // False closures show nothing about the information.
  if (5 * gaps.closures.size() < problem.closures.size()) {
    std::vector<Edge> plausible;
    std::vector<SquaredError> of_plausible;
    for (std::size_t i = 0; i < problem.closures.size(); ++i) {
      if (std::ranges::find(gaps.closures, i) != gaps.closures.end()) continue;
      plausible.push_back(problem.closures[i]);
      of_plausible.push_back(errors[i]);
    }
    const std::vector<Neighbours> pairs = neighbours_of(plausible, chain);
    const std::vector<SquaredError> of_pairs = neighbour_errors(pairs, chain);
    for (const auto& found : {check_information(plausible, of_plausible, of_pairs, chain),
                              check_edges(plausible, pairs, of_pairs)}) {
      out.insert(out.end(), found.begin(), found.end());
    }
  }
  std::erase_if(out, [](const InputFinding& f) { return f.confidence < kLeastConfidence; });
  return out;
}

}  // namespace loopbench::metrics

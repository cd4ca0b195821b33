#include "metrics/doctor/edge_checks.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <set>

#include "metrics/doctor/common_motion.hpp"

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

}  // namespace

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

}  // namespace loopbench::metrics

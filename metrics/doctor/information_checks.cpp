#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "metrics/doctor/common_motion.hpp"
#include "metrics/doctor/graph_checks.hpp"
#include "metrics/doctor/loop_likelihood.hpp"

namespace loopbench::metrics {
namespace {

constexpr std::size_t kOdometry = 0, kClosures = 1;  // in LoopGroup::Logarithms

/// Medians over every other group from `first` on.
LoopGroup::Logarithms median_factors(const std::vector<LoopGroup>& groups) {
  std::vector<double> of_odometry, of_closures;
  for (std::size_t i = 0; i < groups.size(); i += step_of(groups)) {
    const LoopGroup::Logarithms factors = groups[i].best_factors();
    of_odometry.push_back(factors[kOdometry]);
    of_closures.push_back(factors[kClosures]);
  }
  return {median_value(std::move(of_odometry)), median_value(std::move(of_closures))};
}

/// Sum of the log likelihoods of the groups that did not contribute to the medians.
double tested(const std::vector<LoopGroup>& groups, const LoopGroup::Logarithms& factors) {
  double out = 0.0;
  const std::size_t step = step_of(groups);
  for (std::size_t i = step - 1; i < groups.size(); i += step) {
    out += groups[i].log_likelihood_of(factors);
  }
  return out;
}

void exchange_blocks(std::vector<Edge>& edges) {
  for (Edge& edge : edges) {
    const Matrix6 given = edge.information;
    edge.information.topLeftCorner<3, 3>() = given.bottomRightCorner<3, 3>();
    edge.information.bottomRightCorner<3, 3>() = given.topLeftCorner<3, 3>();
  }
}

/// Gain of the log likelihood, each with the factors that fit best. One group, whose closures may
/// be false, counts up to a limit.
double gain_of_order(const std::vector<LoopGroup>& as_read, const std::vector<LoopGroup>& other) {
  constexpr double kMostOfGroup = 20.0;
  double out = 0.0;
  for (std::size_t i = 0; i < as_read.size(); ++i) {
    const double gain = other[i].log_likelihood_of(other[i].best_factors()) -
                        as_read[i].log_likelihood_of(as_read[i].best_factors());
    out += std::clamp(gain, -kMostOfGroup, kMostOfGroup);
  }
  return out;
}

/// Stated variances are too small, or too large.
bool is_far(double logarithm) { return logarithm > std::log(100.0) || logarithm < std::log(1e-5); }

/// Measurements without noise show nothing about its size.
bool is_exact(const LoopGroup::Logarithms& factors) {
  return std::max(factors[kOdometry], factors[kClosures]) < std::log(1e-10);
}

bool is_any_far(const LoopGroup::Logarithms& factors) {
  return is_far(factors[kOdometry]) || is_far(factors[kClosures]);
}

}  // namespace

std::optional<InputFinding> check_information(const Problem& problem, const Chain& chain) {
  constexpr std::size_t kFewest = 2;
  constexpr double kLeastOfOrder = 5.0, kLeastProven = 3.0;  // in logarithms of the likelihood
  if (problem.closures.size() < kFewest) return std::nullopt;
  const std::vector<LoopGroup> groups = groups_of(problem.closures, chain);
  const LoopGroup::Logarithms factors = median_factors(groups);
  if (is_exact(factors)) return std::nullopt;
  Problem other = problem;
  exchange_blocks(other.odometry);
  exchange_blocks(other.closures);
  const Chain other_chain = chain_of(other);
  const std::vector<LoopGroup> other_groups = groups_of(other.closures, other_chain);
  const double gain = gain_of_order(groups, other_groups);
  if (gain > kLeastOfOrder * static_cast<double>(groups.size()) &&
      !is_any_far(median_factors(other_groups))) {
    return InputFinding{
        Fault::information_order,
        fmt::format("exchanging the blocks of translation and rotation makes the gaps of the loops "
                    "likelier (logarithm of the ratio {:.1f})",
                    gain),
        "check the order of the blocks: g2o has those of x y z first",
        1.0 - std::exp(-0.25 * (gain)),
        gain};
  }
  if (!is_any_far(factors)) return std::nullopt;
  const double before = tested(groups, {0.0, 0.0}), after = tested(groups, factors);
  if (after - before < kLeastProven) return std::nullopt;
  const bool of_both = is_far(factors[kOdometry]) && is_far(factors[kClosures]);
  const bool of_odometry = is_far(factors[kOdometry]);
  const char* edges = of_both ? "all edges" : of_odometry ? "the odometry" : "the closures";
  const double factor = std::exp(factors[of_odometry ? kOdometry : kClosures]);
  return InputFinding{
      Fault::information_scale,
      fmt::format("the gaps of the loops fit {:.1g} times the stated variances of {} (median of {} "
                  "groups of loops; logarithm of the ratio of likelihoods {:.1f})",
                  factor,
                  edges,
                  groups.size(),
                  after - before),
      fmt::format("check the information of {}; for a trajectory: options {}{}",
                  edges,
                  of_odometry ? "odometry.sigma_*" : "closures.sigma_*",
                  of_both ? ", closures.sigma_*" : ""),
      0.8,
      factor};
}

}  // namespace loopbench::metrics

/// Smallest gains that a comparison can find.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <vector>

#include "harness/compare/rank_sum.hpp"
#include "harness/compare/signed_rank.hpp"

namespace loopbench::harness {

/// Gains that the test finds with a probability of 80 %, for normal log ratios.
class Power {
 public:
  /// `alpha` is that of one test, after the correction for their number. `strata`: sequences whose
  /// runs are independent; "groups" are then the runs of either method on each of them.
  explicit Power(double alpha, std::size_t strata = 0) : alpha_(alpha), strata_(strata) {}

  /// The smallest mean log ratio over its standard deviation (of two runs, if these are
  /// independent); infinite if no number of equal signs is significant. Signed ranks: up to 200
  /// groups by simulation with fixed draws, beyond by the test's asymptotic efficiency; rank sums:
  /// by the normal approximation of Noether (1987). O(groups log groups), remembered.
  double smallest_effect(std::size_t groups);

  /// The fewest groups that find this mean over standard deviation; at most `kMostGroups`, which
  /// means that or more.
  std::size_t groups_needed(double effect);

  static constexpr std::size_t kMostGroups = 100'000;

 private:
  double smallest_of_strata(std::size_t runs) const;

  double alpha_;
  std::size_t strata_;
  std::map<std::size_t, double> known_;
};

inline constexpr double kWanted = 0.8;
inline constexpr int kDraws = 1000;
inline constexpr std::size_t kMostSimulated = 200;

inline double uniform_draw(std::mt19937_64& bits) {
  return (static_cast<double>(bits() >> 11) + 0.5) * 0x1p-53;
}

/// Share of the draws that are significant: their p is small enough or, where that takes long, the
/// ranks of their positive values sum to `critical` at most.
inline double simulated_power(double effect,
                              std::size_t groups,
                              double alpha,
                              std::size_t critical) {
  std::mt19937_64 bits(groups);
  std::vector<double> values(groups);
  int found = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    for (double& value : values) {
      value = std::sqrt(-2.0 * std::log(uniform_draw(bits))) *
                  std::cos(2.0 * std::numbers::pi * uniform_draw(bits)) -
              effect;
    }
    if (groups <= kMostOrdered) {
      const SignedRank test = signed_rank(values);
      found += test.p <= alpha && test.positive < test.negative ? 1 : 0;
      continue;
    }
    std::ranges::sort(values, {}, [](double value) { return std::abs(value); });
    std::size_t sum = 0;
    for (std::size_t i = 0; i < groups; ++i) sum += values[i] > 0.0 ? i + 1 : 0;
    found += sum <= critical ? 1 : 0;
  }
  return static_cast<double>(found) / kDraws;
}

/// The z with normal_cdf(z) = p, by bisection.
inline double normal_quantile(double p) {
  double low = -40.0;
  double high = 40.0;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (normal_cdf(middle) < p ? low : high) = middle;
  }
  return high;
}

inline double Power::smallest_of_strata(std::size_t runs) const {
  const std::vector<Stratum> strata(strata_, {runs, runs});
  if (2.0 * rank_sum_tail(strata, 0) > alpha_) return std::numeric_limits<double>::infinity();
  const double distance = normal_quantile(1.0 - 0.5 * alpha_) + normal_quantile(kWanted);
  const auto n = static_cast<double>(runs);
  const double deviation = std::sqrt((2.0 * n + 1.0) / (12.0 * static_cast<double>(strata_))) / n;
  const double ahead = 0.5 + distance * deviation;  // share of the pairs of runs
  return ahead < 1.0 ? normal_quantile(ahead) : std::numeric_limits<double>::infinity();
}

inline double Power::smallest_effect(std::size_t groups) {
  const auto [found, is_new] = known_.emplace(groups, std::numeric_limits<double>::infinity());
  if (!is_new) return found->second;
  if (strata_ > 0) return found->second = smallest_of_strata(groups);
  const auto critical = critical_rank_sum(groups, alpha_);
  if (!critical) return found->second;
  if (groups > kMostSimulated) {
    const double efficiency = 3.0 / std::numbers::pi;
    const double distance = normal_quantile(1.0 - 0.5 * alpha_) + normal_quantile(kWanted);
    return found->second = distance / std::sqrt(efficiency * static_cast<double>(groups));
  }
  double low = 0.0;
  double high = 10.0;
  while (high - low > 1e-3 * high) {
    const double middle = 0.5 * (low + high);
    (simulated_power(middle, groups, alpha_, *critical) < kWanted ? low : high) = middle;
  }
  return found->second = high;
}

inline std::size_t Power::groups_needed(double effect) {
  std::size_t low = 0;
  std::size_t high = kMostGroups;
  while (low + 1 < high) {
    const std::size_t middle = low + (high - low) / 2;
    (smallest_effect(middle) > effect ? low : high) = middle;
  }
  return high;
}

}  // namespace loopbench::harness

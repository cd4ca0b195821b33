#include "harness/statistics/signed_rank.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "harness/statistics/normal.hpp"
#include "harness/statistics/ranks.hpp"

namespace loopbench::harness {
namespace {

struct Tails {
  double lower;  ///< P(T <= t)
  double upper;  ///< P(T >= t)
};

/// Exact distribution of the sum of ranks with random signs. Midranks are doubled to be integers.
Tails exact_tails(const std::vector<double>& ranks, double t) {
  std::size_t total = 0;
  for (const double rank : ranks) total += static_cast<std::size_t>(std::lround(2.0 * rank));
  std::vector<double> chance(total + 1, 0.0);
  chance[0] = 1.0;
  std::size_t reached = 0;
  for (const double rank : ranks) {
    const auto step = static_cast<std::size_t>(std::lround(2.0 * rank));
    reached += step;
    for (std::size_t sum = reached + 1; sum-- > 0;) {
      chance[sum] = 0.5 * (chance[sum] + (sum >= step ? chance[sum - step] : 0.0));
    }
  }
  const auto at = static_cast<std::size_t>(std::lround(2.0 * t));
  Tails tails{0.0, 0.0};
  for (std::size_t sum = 0; sum <= total; ++sum) {
    if (sum <= at) tails.lower += chance[sum];
    if (sum >= at) tails.upper += chance[sum];
  }
  return tails;
}

/// Variance given the observed ranks, which is correct with ties and dropped zeros.
Tails normal_tails(const std::vector<double>& ranks, double t, bool continuity) {
  double center = 0.0;
  double variance = 0.0;
  for (const double rank : ranks) {
    center += 0.5 * rank;
    variance += 0.25 * rank * rank;
  }
  const double half = continuity ? 0.5 : 0.0;
  const double deviation = std::sqrt(variance);
  return {normal_cdf((t - center + half) / deviation), normal_cdf((center - t + half) / deviation)};
}

double chosen(const Tails& tails, Alternative alternative) {
  if (alternative == Alternative::less) return tails.lower;
  if (alternative == Alternative::greater) return tails.upper;
  return 2.0 * std::min(tails.lower, tails.upper);
}

}  // namespace

SignedRank signed_rank(std::span<const double> differences, const SignedRankOptions& options) {
  std::vector<double> magnitudes;
  std::vector<bool> signs;
  SignedRank out;
  for (const double difference : differences) {
    if (difference == 0.0) ++out.zeros;
    if (difference == 0.0 && options.zeros == Zeros::wilcoxon) continue;
    magnitudes.push_back(std::abs(difference));
    signs.push_back(difference > 0.0);
  }
  const std::vector<double> all = midranks(magnitudes);
  std::vector<double> ranks;  // of non-zero differences
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (magnitudes[i] == 0.0) continue;
    ranks.push_back(all[i]);
    (signs[i] ? out.positive : out.negative) += all[i];
  }
  out.count = ranks.size();
  if (ranks.empty()) return out;
  out.is_exact = ranks.size() <= options.exact_up_to;
  const Tails tails = out.is_exact ? exact_tails(ranks, out.positive)
                                   : normal_tails(ranks, out.positive, options.continuity);
  out.p = std::min(1.0, chosen(tails, options.alternative));
  return out;
}

double rank_biserial(const SignedRank& test) {
  const double total = test.positive + test.negative;
  return total > 0.0 ? (test.positive - test.negative) / total : 0.0;
}

double least_p(std::size_t n) { return std::min(1.0, std::pow(2.0, 1.0 - static_cast<double>(n))); }

}  // namespace loopbench::harness

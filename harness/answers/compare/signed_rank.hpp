/// Wilcoxon's signed-rank test of the symmetry of paired differences about zero, and the
/// Hodges-Lehmann estimate with the interval that inverts it (Hollander and Wolfe, Nonparametric
/// Statistical Methods, 3.1 to 3.3).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <optional>
#include <span>
#include <vector>

namespace loopbench::harness {

/// Relative difference up to which two errors count as equal: smaller ones are due to rounding,
/// summation order or solver, for any p value.
inline constexpr double kTieShare = 1e-6;

/// Whether |a - b| <= tie * max(|a|, |b|).
inline bool tied(double a, double b, double tie) {
  return std::abs(a - b) <= tie * std::max(std::abs(a), std::abs(b));
}

/// 1 for the smallest; equal values get the mean of their ranks. No NaN. O(n log n).
inline std::vector<double> midranks(std::span<const double> values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return values[i]; });
  std::vector<double> ranks(values.size());
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    end = begin + 1;
    while (end < order.size() && values[order[end]] == values[order[begin]]) ++end;
    const double shared = 0.5 * static_cast<double>(begin + 1 + end);
    for (std::size_t i = begin; i < end; ++i) ranks[order[i]] = shared;
  }
  return ranks;
}

/// More differences use the normal approximation.
inline constexpr std::size_t kMostExact = 50;

/// Equal rank sums of so many differences are ordered by the number of their ranks, so that the
/// attainable levels are closer to any nominal one: 4.7 instead of 3.9 % for 8 differences and 5 %.
inline constexpr std::size_t kMostOrdered = 20;

struct SignedRank {
  std::size_t count = 0;  ///< number of non-zero differences
  double positive = 0.0;  ///< sum of the ranks of positive differences
  double negative = 0.0;
  double p = 1.0;  ///< two-sided; 1 if every difference is zero
};

/// Zeros are ranked with the others and then dropped (Pratt, 1959), so that many ties make
/// significance harder; equal magnitudes share their ranks. The exact p enumerates the sign
/// patterns given the observed ranks, so it is valid with ties and zeros, too: twice the smaller
/// tail. The normal approximation has a continuity correction. No NaN. O(n log n), exact O(n^3).
SignedRank signed_rank(std::span<const double> differences, std::size_t most_exact = kMostExact);

/// The largest sum c of the ranks of one sign with 2 P(sum <= c) <= alpha for n differences without
/// ties; nullopt if there is none. O(n^3 log n) if exact.
std::optional<std::size_t> critical_rank_sum(std::size_t n, double alpha);

/// The smallest two-sided p for n differences: 2^(1 - n), if all have one sign.
double least_p(std::size_t n);

/// A difference to a failure or to an error of zero, which exceeds all others.
inline constexpr double kNoRatio = 1e300;

struct Interval {
  double estimate = 0.0;
  double low = 0.0;
  double high = 0.0;
};

/// The k-th smallest, from 1, of the n (n + 1) / 2 means of two of the values or of one with
/// itself. Values of +-kNoRatio stay that, and half of the means of opposite ones belong to either
/// end. `sorted` is ascending. O(64 n).
double walsh_average(std::span<const double> sorted, std::size_t k);

/// Median of the same means; at least one value. O(64 n).
double pseudo_median(std::span<const double> sorted);

/// The pseudo-median and all shifts that the signed-rank test does not reject at level `alpha`;
/// nullopt if the test rejects none, because there are too few values. Ends can be +-kNoRatio.
std::optional<Interval> shift_interval(std::span<const double> sorted, double alpha);

/// P(Z <= z) of the standard normal distribution, to a few ulp in both tails.
double normal_cdf(double z);

/// The largest c in 0..most with 2 tail(c) <= alpha, for a tail that grows with c; nullopt if there
/// is none. O(log most) calls.
template <class Tail>
std::optional<std::size_t> largest_rejected(std::size_t most, double alpha, Tail tail) {
  std::size_t accepted = most + 1;  // the first that may be accepted
  for (std::size_t low = 0; low < accepted;) {
    const std::size_t middle = low + (accepted - low) / 2;
    if (2.0 * tail(middle) <= alpha) {
      low = middle + 1;
    } else {
      accepted = middle;
    }
  }
  return accepted == 0 ? std::nullopt : std::optional(accepted - 1);
}

}  // namespace loopbench::harness

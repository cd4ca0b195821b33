/// Typical value of a few numbers (Hodges and Lehmann), and when two errors are equal.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

namespace loopbench::harness {

/// Relative difference up to which two errors count as equal: smaller ones are due to rounding,
/// summation order or solver, for any p value.
inline constexpr double kTieShare = 1e-6;

/// Whether |a - b| <= tie * max(|a|, |b|).
inline bool tied(double a, double b, double tie) {
  return std::abs(a - b) <= tie * std::max(std::abs(a), std::abs(b));
}

/// Log ratio to an error of zero, a factor of 1e-12.
inline constexpr double kZeroRatio = 27.6;

struct Interval {
  double estimate = 0.0;
  double low = 0.0;
  double high = 0.0;
};

/// The k-th smallest, from 1, of the n (n + 1) / 2 means of two of the values or of one with
/// itself. `sorted` is ascending and not empty. O(64 n).
double walsh_average(std::span<const double> sorted, std::size_t k);

/// Median of the same means (Hodges and Lehmann, 1963). O(64 n).
double pseudo_median(std::span<const double> sorted);

}  // namespace loopbench::harness

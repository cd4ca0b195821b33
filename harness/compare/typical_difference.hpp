/// Hodges-Lehmann estimate of paired differences with the interval that inverts the signed-rank
/// test (Hollander and Wolfe, Nonparametric Statistical Methods, 3.2 and 3.3).
#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace loopbench::harness {

/// A difference to a failure or to an error of zero, which exceeds all others.
inline constexpr double kBeyond = 1e300;

struct Interval {
  double estimate = 0.0;
  double low = 0.0;
  double high = 0.0;
};

/// The k-th smallest, from 1, of the n (n + 1) / 2 means of two of the values or of one with
/// itself. Values of +-kBeyond stay that, and half of the means of opposite ones belong to either
/// end. `sorted` is ascending. O(64 n).
double walsh_average(std::span<const double> sorted, std::size_t k);

/// Median of the same means; at least one value. O(64 n).
double pseudo_median(std::span<const double> sorted);

/// The pseudo-median and all shifts that the signed-rank test does not reject at level `alpha`;
/// nullopt if the test rejects none, because there are too few values. Ends can be +-kBeyond.
std::optional<Interval> shift_interval(std::span<const double> sorted, double alpha);

}  // namespace loopbench::harness

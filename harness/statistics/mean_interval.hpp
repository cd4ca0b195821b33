/// Confidence interval of the mean of few, possibly skewed observations.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

namespace loopbench::harness {

/// Minimum number of observations for an interval.
inline constexpr std::size_t kFewestForInterval = 8;

struct Interval {
  double estimate = 0.0;
  double low = 0.0;
  double high = 0.0;
};

struct MeanInterval {
  Interval interval;
  double p = 1.0;  ///< p for a mean of zero; at most 1 - level exactly if the interval excludes 0
};

/// Mean with a Student interval that is corrected for skewness. Few values estimate skewness
/// poorly: too low for distributions with a long tail, not zero for symmetric ones. Hence a test
/// rather than an estimate: if the sample skewness over sqrt(n), which is the skewness of the mean,
/// exceeds 0.39 - 1.2 / n, the end in the longer tail is 3.5 times as far from the mean as
/// Student's (1.5 times if a third of the values or more are ties, and linear between), and the
/// other end as far as Student's. Up to 0.29 - 1.2 / n both are 1 - 10 / n^2 times as far; between
/// the two, all factors are interpolated linearly.
///
/// These numbers make 95 % intervals cover 93 to 97 % from kFewestForInterval observations on for
/// normal, uniform, Laplace, t (3 degrees of freedom), contaminated normal, gamma (skewness 1),
/// exponential, Weibull (shape 0.7) and lognormal values (sigma 0.5 to 1; skewness 1.8 to 6), and
/// 94 to 98 % if half of such values are ties. results/methods/intervals.md shows this, and
/// distributions on which the numbers were not chosen (`tests/studies/interval_coverage`): values
/// in two clusters, the worst, are covered up to 99.8 %. Coverage is that of all samples together;
/// samples that do not look skewed are covered less often than those that do.
///
/// With few values that differ from the most frequent one, coverage depends on how many they are,
/// so there is no interval if less than 40 % (and fewer than 30), or fewer than 5, differ.
///
/// Limit: no interval of finite length covers the mean for every distribution (Bahadur and Savage,
/// Annals of Mathematical Statistics 27, 1956): an interval misses the mean if the sample lacks
/// rare large values, and such a sample looks regular.
///
/// nullopt if why_no_interval gives a reason. Throws std::invalid_argument for a level outside
/// (0, 1). O(n log n).
std::optional<MeanInterval> mean_interval(std::span<const double> values, double level = 0.95);

/// Reason why mean_interval returns nullopt: "7 observations, 8 are needed"; otherwise empty.
std::string why_no_interval(std::span<const double> values);

}  // namespace loopbench::harness

/// Confidence interval of the mean of few, possibly skewed observations.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

namespace loopbench::harness {

/// Minimum number of observations for an interval.
inline constexpr std::size_t kFewestForInterval = 8;
/// Minimum number of observations that differ from the most frequent value.
inline constexpr std::size_t kFewestThatDiffer = 5;

struct Interval {
  double estimate = 0.0;
  double low = 0.0;
  double high = 0.0;
};

struct MeanInterval {
  Interval interval;
  double p = 1.0;  ///< p for a mean of zero; at most 1 - level exactly if the interval excludes 0
};

/// Mean with a Student interval that is corrected for skewness by Hall's cubic transformation
/// (Journal of the Royal Statistical Society B 54, 1992). Few values estimate
/// skewness poorly: too low for distributions with a long tail, not zero for symmetric ones. The
/// end in the longer tail therefore assumes 1.7 times the bias-corrected sample skewness, and is at
/// most three times as far from the mean as Student's; the other end assumes half the sample
/// skewness. The degrees of freedom are the number of values that differ, by more than rounding,
/// from the most frequent one: n - 1 without ties, fewer with ties, which say nothing about the
/// deviation (ties are not counted if a thousand of the first values differ; they hardly matter
/// then).
///
/// 95 % intervals cover 93 to 97 % from kFewestForInterval observations on for normal, Laplace,
/// t (3 degrees of freedom), gamma (skewness 1), exponential and lognormal values (sigma 0.5 and 1;
/// skewness 1.8 and 6), 97 to 98 % for uniform ones, and 95 to 99 % with many ties
/// (`tests/studies/interval_coverage`, results/methods/intervals.md). With fewer observations the
/// lognormal with sigma 1 falls below 93 %, so none is given.
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

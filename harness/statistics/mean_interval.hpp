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

/// Mean with Hall's skewness-corrected Student interval (Journal of the Royal Statistical Society B
/// 54, 1992), with three quarters of the bias-corrected sample skewness: with the full
/// skewness, coverage is below 93 % for heavy tails; without it, below 93 % for skewed values.
/// The degrees of freedom are the number of values that differ, by more than rounding, from the
/// most frequent one: n - 1 without ties, fewer with ties, which say nothing about the deviation
/// (ties are not counted if a thousand of the first values differ; they hardly matter then).
///
/// 95 % intervals cover 93 to 97 % from kFewestForInterval observations on for normal, uniform,
/// Laplace, t (3 degrees of freedom), gamma (skewness 1), lognormal (sigma 0.5) and exponential
/// values, and 93 to 99 % with many ties (`tests/studies/interval_coverage`,
/// results/methods/intervals.md). With fewer observations the exponential falls below 93 %, so none
/// is given.
///
/// Limit: no interval of finite length covers the mean for every distribution (Bahadur and Savage,
/// Annals of Mathematical Statistics 27, 1956). Lognormal values with sigma 1 (skewness 6) are
/// covered to 89 % at n = 8 and 92 % at n = 30. This cannot be detected from the sample: an
/// interval misses the mean if the sample lacks the rare large values, so the sample looks regular.
/// Rejecting samples of large skewness, or with one dominating value, would therefore lower the
/// coverage of the remaining intervals, and there is no such rule.
///
/// nullopt if why_no_interval gives a reason. Throws std::invalid_argument for a level outside
/// (0, 1). O(n log n).
std::optional<MeanInterval> mean_interval(std::span<const double> values, double level = 0.95);

/// Reason why mean_interval returns nullopt: "7 observations, 8 are needed"; otherwise empty.
std::string why_no_interval(std::span<const double> values);

}  // namespace loopbench::harness

#include "harness/statistics/mean_interval.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "harness/statistics/average.hpp"
#include "harness/statistics/student.hpp"

namespace loopbench::harness {
namespace {

/// With this many values that differ, ties change an interval by at most 0.1 %.
constexpr std::size_t kManyThatDiffer = 1000;

struct Ties {
  std::size_t distinct = 0;       ///< number of values, those equal but for rounding counted once
  std::size_t most_frequent = 0;  ///< how often the most frequent one occurs
};

Ties count_ties(std::span<const double> values, double rounding) {
  std::vector<double> sorted(values.begin(), values.end());
  std::ranges::sort(sorted);
  Ties out;
  for (std::size_t first = 0, i = 0; i < sorted.size(); ++i) {
    if (i == 0 || sorted[i] - sorted[first] > rounding) {
      first = i;
      ++out.distinct;
    }
    out.most_frequent = std::max(out.most_frequent, i - first + 1);
  }
  return out;
}

/// Number of values that differ, by more than rounding, from the most frequent one. If the first
/// ones show that there are many, the rest is taken to differ without sorting it.
std::size_t differing(std::span<const double> values) {
  double largest = 0.0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  const double rounding = 1e-9 * largest;
  constexpr std::size_t kFirst = 2 * kManyThatDiffer;
  if (values.size() > kFirst &&
      count_ties(values.first(kFirst), rounding).distinct > kManyThatDiffer) {
    return values.size() - 1;
  }
  return values.size() - count_ties(values, rounding).most_frequent;
}

/// Sample skewness, corrected for bias.
double sample_skewness(std::span<const double> values, double middle, double deviation) {
  double cubes = 0.0;
  for (const double value : values) {
    const double own = (value - middle) / deviation;
    cubes += own * own * own;
  }
  const auto n = static_cast<double>(values.size());
  return n / ((n - 1.0) * (n - 2.0)) * cubes;
}

/// Towards the shorter tail: the distance r of the true mean from the sample mean, in sample
/// deviations, and the t of Hall's transformation, which is about Student's.
struct ShortTail {
  double skewness;  ///< not negative
  double n;

  double t(double r) const {
    const double cubic = r + skewness * r * r / 3.0 + skewness * skewness * r * r * r / 27.0;
    return std::sqrt(n) * (cubic + skewness / (6.0 * n));
  }
  double r(double t) const {
    const double cubic = t / std::sqrt(n) - skewness / (6.0 * n);
    if (skewness < 1e-8) return cubic;
    return 3.0 / skewness * (std::cbrt(1.0 + skewness * cubic) - 1.0);
  }
};

/// Towards the longer tail: the same. Hall's cubic is used up to its stationary point, r = 3 /
/// skewness, where r is three times Student's; beyond that, r remains three times Student's.
struct LongTail {
  double skewness;  ///< not negative
  double n;

  double t(double r) const {
    if (skewness * r >= 3.0) return std::sqrt(n) * r / 3.0;
    return std::sqrt(n) * (r - skewness * r * r / 3.0 + skewness * skewness * r * r * r / 27.0);
  }
  double r(double t) const {
    const double student = t / std::sqrt(n);
    if (skewness < 1e-8) return student;
    if (skewness * student >= 1.0) return 3.0 * student;
    return 3.0 / skewness * (1.0 - std::cbrt(1.0 - skewness * student));
  }
};

}  // namespace

std::string why_no_interval(std::span<const double> values) {
  if (values.size() < kFewestForInterval) {
    return fmt::format("{} observation{}, {} are needed",
                       values.size(),
                       values.size() == 1 ? "" : "s",
                       kFewestForInterval);
  }
  const std::size_t count = differing(values);
  if (count >= kFewestThatDiffer) return "";
  return fmt::format("{} of {} observations differ from the most frequent value, {} must",
                     count,
                     values.size(),
                     kFewestThatDiffer);
}

std::optional<MeanInterval> mean_interval(std::span<const double> values, double level) {
  if (!(level > 0.0 && level < 1.0)) {
    throw std::invalid_argument("an interval needs a level within (0, 1)");
  }
  if (values.size() < kFewestForInterval) return std::nullopt;
  const std::size_t freedom = differing(values);
  if (freedom < kFewestThatDiffer) return std::nullopt;
  const auto n = static_cast<double>(values.size());
  const double middle = mean(values);
  const double deviation = sample_deviation(values);
  const double skewness = sample_skewness(values, middle, deviation);
  const ShortTail shorter{0.5 * std::abs(skewness), n};
  const LongTail longer{1.7 * std::abs(skewness), n};
  const double t = student_quantile(1.0 - level, freedom);
  const double below = skewness > 0.0 ? shorter.r(t) : longer.r(t);
  const double above = skewness > 0.0 ? longer.r(t) : shorter.r(t);
  const double to_zero = std::abs(middle) / deviation;
  const bool zero_is_in_longer = (skewness > 0.0) == (middle < 0.0);
  return MeanInterval{
      {middle, middle - deviation * below, middle + deviation * above},
      student_p(zero_is_in_longer ? longer.t(to_zero) : shorter.t(to_zero), freedom)};
}

}  // namespace loopbench::harness

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

/// Three quarters of the bias-corrected sample skewness.
double applied_skewness(std::span<const double> values, double middle, double deviation) {
  double cubes = 0.0;
  for (const double value : values) {
    const double own = (value - middle) / deviation;
    cubes += own * own * own;
  }
  const auto n = static_cast<double>(values.size());
  return 0.75 * n / ((n - 1.0) * (n - 2.0)) * cubes;
}

/// Hall's transformation of (mean - expectation) / deviation, about Student's t for skewed values.
double symmetrised(double ratio, double skewness, double n) {
  const double cubic =
      ratio + skewness * ratio * ratio / 3.0 + skewness * skewness * ratio * ratio * ratio / 27.0;
  return std::sqrt(n) * (cubic + skewness / (6.0 * n));
}

/// Inverse of symmetrised.
double skewed(double t, double skewness, double n) {
  const double cubic = t / std::sqrt(n) - skewness / (6.0 * n);
  if (std::abs(skewness) < 1e-8) return cubic;
  return 3.0 / skewness * (std::cbrt(1.0 + skewness * cubic) - 1.0);
}

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
  const double skewness = applied_skewness(values, middle, deviation);
  const double t = student_quantile(1.0 - level, freedom);
  return MeanInterval{{middle,
                       middle - deviation * skewed(t, skewness, n),
                       middle - deviation * skewed(-t, skewness, n)},
                      student_p(symmetrised(middle / deviation, skewness, n), freedom)};
}

}  // namespace loopbench::harness

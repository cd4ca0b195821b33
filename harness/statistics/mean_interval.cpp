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

/// Whether some of the first values are kFewestThatDiffer + 1 that all differ by more than
/// rounding: then as many differ from the most frequent value, and differing() need not sort.
bool surely_differ(std::span<const double> values) {
  constexpr std::size_t kFirst = 64;
  double largest = 0.0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  std::vector<double> found;
  for (const double value : values.first(std::min(kFirst, values.size()))) {
    const auto is_near = [&](double one) { return std::abs(one - value) <= 2e-9 * largest; };
    if (std::ranges::none_of(found, is_near)) found.push_back(value);
    if (found.size() > kFewestThatDiffer) return true;
  }
  return false;
}

/// Number of values that differ, by more than rounding, from the most frequent one.
std::size_t differing(std::span<const double> values) {
  std::vector<double> sorted(values.begin(), values.end());
  std::ranges::sort(sorted);
  const double rounding = 1e-9 * std::max(std::abs(sorted.front()), std::abs(sorted.back()));
  std::size_t most = 0;
  for (std::size_t first = 0, i = 0; i < sorted.size(); ++i) {
    if (sorted[i] - sorted[first] > rounding) first = i;
    most = std::max(most, i - first + 1);
  }
  return sorted.size() - most;
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
  if (surely_differ(values)) return "";
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
  if (!why_no_interval(values).empty()) return std::nullopt;
  const auto n = static_cast<double>(values.size());
  const double middle = mean(values);
  const double deviation = sample_deviation(values);
  const double skewness = applied_skewness(values, middle, deviation);
  const double t = student_quantile(1.0 - level, values.size() - 1);
  return MeanInterval{{middle,
                       middle - deviation * skewed(t, skewness, n),
                       middle - deviation * skewed(-t, skewness, n)},
                      student_p(symmetrised(middle / deviation, skewness, n), values.size() - 1)};
}

}  // namespace loopbench::harness

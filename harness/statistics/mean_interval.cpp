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

/// Needed number of values that differ from the most frequent one: of fewer than 75 values, 40 %.
std::size_t fewest_that_differ(std::size_t count) {
  return std::clamp<std::size_t>((2 * count + 4) / 5, 5, 30);
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

/// Distances of an interval's ends from the mean, relative to Student's.
struct Reach {
  double longer_tail = 1.0;
  double shorter_tail = 1.0;
};

/// All numbers are fitted to coverage (mean_interval.hpp).
Reach reach(double skewness, double count, double most_frequent) {
  // A sample of n values is taken for skewed if the skewness of its mean is unusual for symmetric
  // values; the fewer there are, the less is unusual for those with a long tail.
  const double of_mean = std::abs(skewness) / std::sqrt(count);
  const double skewed = std::clamp(10.0 * of_mean - 2.9 + 12.0 / count, 0.0, 1.0);
  // Ties beside a few larger values look like a long tail although there is none.
  const double ties = most_frequent > 1.0 ? most_frequent / count : 0.0;
  const double furthest = 3.5 - 2.0 * std::min(1.0, 3.0 * ties);
  // Samples that look skewed are covered too often then, so that others may be so less often.
  const double symmetric = 1.0 - 10.0 / (count * count);
  return {std::lerp(symmetric, furthest, skewed), std::lerp(symmetric, 1.0, skewed)};
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
  const std::size_t needed = fewest_that_differ(values.size());
  if (count >= needed) return "";
  return fmt::format("{} of {} observations differ from the most frequent value, {} must",
                     count,
                     values.size(),
                     needed);
}

std::optional<MeanInterval> mean_interval(std::span<const double> values, double level) {
  if (!(level > 0.0 && level < 1.0)) {
    throw std::invalid_argument("an interval needs a level within (0, 1)");
  }
  if (values.size() < kFewestForInterval) return std::nullopt;
  const std::size_t unlike = differing(values);
  if (unlike < fewest_that_differ(values.size())) return std::nullopt;
  const auto n = static_cast<double>(values.size());
  const double middle = mean(values);
  const double deviation = sample_deviation(values);
  const double skewness = sample_skewness(values, middle, deviation);
  const Reach ends = reach(skewness, n, n - static_cast<double>(unlike));
  const double below = skewness > 0.0 ? ends.shorter_tail : ends.longer_tail;
  const double above = skewness > 0.0 ? ends.longer_tail : ends.shorter_tail;
  const double error = deviation / std::sqrt(n);
  const double student = error * student_quantile(1.0 - level, values.size() - 1);
  const double t = std::abs(middle) / (error * (middle > 0.0 ? below : above));
  return MeanInterval{{middle, middle - student * below, middle + student * above},
                      student_p(t, values.size() - 1)};
}

}  // namespace loopbench::harness

#include "harness/statistics/mean_interval.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include "harness/statistics/average.hpp"

namespace loopbench {
namespace {

struct Moments {
  double mean = 0.0;
  double error = 0.0;  // standard error of the mean
};

Moments moments(std::span<const double> values) {
  const auto n = static_cast<double>(values.size());
  return {mean(values), sample_deviation(values) / std::sqrt(n)};
}

/// In [0, count); std::uniform_int_distribution differs between standard libraries.
std::size_t random_index(std::mt19937_64& bits, std::size_t count) {
  return static_cast<std::size_t>(static_cast<double>(bits() >> 11) * 0x1p-53 *
                                  static_cast<double>(count));
}

/// |mean* - mean| / error* of every resample, ascending; infinite where a resample has no spread.
std::vector<double> studentised(std::span<const double> values,
                                const Moments& all,
                                const ResamplingOptions& options) {
  std::mt19937_64 bits(options.seed);
  std::vector<double> resample(values.size());
  std::vector<double> out(options.resamples);
  for (double& t : out) {
    for (double& value : resample) value = values[random_index(bits, values.size())];
    const Moments own = moments(resample);
    const bool has_spread = own.error > 1e-9 * all.error;
    t = has_spread ? std::abs(own.mean - all.mean) / own.error
                   : std::numeric_limits<double>::infinity();
  }
  std::ranges::sort(out);
  return out;
}

}  // namespace

std::optional<MeanInterval> mean_interval(std::span<const double> values,
                                          const ResamplingOptions& options) {
  if (options.resamples == 0 || !(options.level > 0.0 && options.level < 1.0)) {
    throw std::invalid_argument("a bootstrap needs resamples and a level within (0, 1)");
  }
  const auto differing = static_cast<std::size_t>(
      std::ranges::count_if(values, [](double value) { return value != 0.0; }));
  if (differing < kFewestForInterval) return std::nullopt;
  const Moments all = moments(values);
  const auto count = static_cast<double>(options.resamples + 1);
  if (!(all.error > 1e-12 * std::abs(all.mean))) {  // all values are the same
    return MeanInterval{{all.mean, all.mean, all.mean}, 1.0 / count};
  }
  const std::vector<double> sorted = studentised(values, all, options);
  // The epsilon keeps 0.95 * 2000 from being rounded up to 1901.
  const auto place = static_cast<std::size_t>(std::ceil(options.level * count - 1e-9));
  if (place > sorted.size() || !std::isfinite(sorted[place - 1])) return std::nullopt;
  const double half = sorted[place - 1] * all.error;
  const double own = std::abs(all.mean) / all.error;
  const auto beyond = sorted.end() - std::ranges::lower_bound(sorted, own);
  return MeanInterval{{all.mean, all.mean - half, all.mean + half},
                      (1.0 + static_cast<double>(beyond)) / count};
}

}  // namespace loopbench

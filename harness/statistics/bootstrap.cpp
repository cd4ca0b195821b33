#include "harness/statistics/bootstrap.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <stdexcept>
#include <vector>

#include "harness/statistics/average.hpp"
#include "harness/statistics/normal.hpp"

namespace loopbench {
namespace {

using Indices = std::vector<std::size_t>;

/// Whole, in [0, count); std::uniform_int_distribution differs between standard libraries.
std::size_t draw(std::mt19937_64& bits, std::size_t count) {
  return static_cast<std::size_t>(static_cast<double>(bits() >> 11) * 0x1p-53 *
                                  static_cast<double>(count));
}

void check(std::size_t n, const BootstrapOptions& options) {
  if (n == 0 || options.resamples == 0 || !(options.level > 0.0 && options.level < 1.0)) {
    throw std::invalid_argument("a bootstrap needs observations, resamples and a level in (0, 1)");
  }
}

double of_all(std::size_t n, const Resampled& statistic) {
  Indices all(n);
  std::iota(all.begin(), all.end(), std::size_t{0});
  return statistic(all);
}

/// Skewness of the statistic's influence values, over 6 sqrt n.
double acceleration(std::size_t n, const Resampled& statistic) {
  std::vector<double> left_out(n);
  Indices others(n - 1);
  for (std::size_t i = 0; i < n; ++i) {
    std::iota(others.begin(), others.end(), std::size_t{0});
    for (std::size_t j = i; j < others.size(); ++j) ++others[j];
    left_out[i] = statistic(others);
  }
  const double center = mean(left_out);
  double squares = 0.0;
  double cubes = 0.0;
  for (const double value : left_out) {
    squares += std::pow(center - value, 2);
    cubes += std::pow(center - value, 3);
  }
  return squares > 0.0 ? cubes / (6.0 * std::pow(squares, 1.5)) : 0.0;
}

std::vector<double> sorted_values(std::size_t n,
                                  std::size_t block,
                                  const Resampled& statistic,
                                  const BootstrapOptions& options) {
  std::vector<double> out = block_values(n, block, statistic, options);
  std::ranges::sort(out);
  return out;
}

}  // namespace

std::vector<double> block_values(std::size_t n,
                                 std::size_t block,
                                 const Resampled& statistic,
                                 const BootstrapOptions& options) {
  check(n, options);
  if (block == 0) throw std::invalid_argument("a block has at least one observation");
  block = std::min(block, n);
  std::mt19937_64 bits(options.seed);
  Indices indices(n);
  std::vector<double> out(options.resamples);
  for (double& value : out) {
    for (std::size_t i = 0; i < n;) {
      const std::size_t begin = draw(bits, n - block + 1);
      for (std::size_t j = 0; j < block && i < n; ++j, ++i) indices[i] = begin + j;
    }
    value = statistic(indices);
  }
  return out;
}

Interval percentile_interval(std::size_t n,
                             const Resampled& statistic,
                             const BootstrapOptions& options) {
  return block_interval(n, 1, statistic, options);
}

Interval block_interval(std::size_t n,
                        std::size_t block,
                        const Resampled& statistic,
                        const BootstrapOptions& options) {
  const std::vector<double> sorted = sorted_values(n, block, statistic, options);
  const double tail = 0.5 * (1.0 - options.level);
  return {of_all(n, statistic), quantile(sorted, tail), quantile(sorted, 1.0 - tail)};
}

Interval bca_interval(std::size_t n, const Resampled& statistic, const BootstrapOptions& options) {
  check(n, options);
  if (n == 1) throw std::invalid_argument("one observation says nothing about its spread");
  const double estimate = of_all(n, statistic);
  const std::vector<double> sorted = sorted_values(n, 1, statistic, options);
  const auto [first, last] = std::ranges::equal_range(sorted, estimate);
  const double below = static_cast<double>(first - sorted.begin());
  const double not_above = static_cast<double>(last - sorted.begin());
  const double bias =
      normal_quantile(0.5 * (below + not_above) / static_cast<double>(sorted.size()));
  const double a = acceleration(n, statistic);
  const auto shifted = [&](double p) {
    if (!std::isfinite(bias)) return p;  // every resample on one side: nothing to correct by
    const double z = bias + normal_quantile(p);
    return normal_cdf(bias + z / (1.0 - a * z));
  };
  const double tail = 0.5 * (1.0 - options.level);
  return {estimate, quantile(sorted, shifted(tail)), quantile(sorted, shifted(1.0 - tail))};
}

}  // namespace loopbench

#include "harness/statistics/block_length.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "harness/statistics/average.hpp"

namespace loopbench {
namespace {

/// Of `centred` values with those `lag` later, over n.
double autocovariance(std::span<const double> centred, std::size_t lag) {
  double sum = 0.0;
  for (std::size_t i = lag; i < centred.size(); ++i) sum += centred[i] * centred[i - lag];
  return sum / static_cast<double>(centred.size());
}

}  // namespace

std::size_t block_length(std::span<const double> values) {
  const double center = mean(values);
  std::vector<double> centred;
  for (const double value : values) centred.push_back(value - center);
  const auto n = static_cast<double>(values.size());

  // The correlogram counts up to where a run of lags is indistinguishable from zero.
  const double log_n = std::log10(n);
  const auto run = static_cast<std::size_t>(std::fmax(5.0, std::ceil(std::sqrt(log_n))));
  const std::size_t most = std::min(values.size() - 1,  //
                                    static_cast<std::size_t>(std::ceil(std::sqrt(n))) + run);
  const double band = 2.0 * std::sqrt(log_n / n);
  std::vector<double> covariance{autocovariance(centred, 0)};
  if (!(covariance[0] > 0.0)) return 1;
  std::size_t last = 0;  // lag that still counts
  for (std::size_t lag = 1; lag <= most && lag - last <= run; ++lag) {
    covariance.push_back(autocovariance(centred, lag));
    if (std::abs(covariance[lag]) > band * covariance[0]) last = lag;
  }

  const std::size_t window = std::min(2 * std::max<std::size_t>(last, 1), values.size() - 1);
  double spectrum = covariance[0];  // at frequency zero
  double curvature = 0.0;
  for (std::size_t lag = 1; lag <= window; ++lag) {
    const double at = static_cast<double>(lag) / static_cast<double>(window);
    const double weight = std::fmin(1.0, 2.0 * (1.0 - at));  // flat top
    const double r = lag < covariance.size() ? covariance[lag] : autocovariance(centred, lag);
    spectrum += 2.0 * weight * r;
    curvature += 2.0 * weight * static_cast<double>(lag) * r;
  }
  const double longest = std::fmin(3.0 * std::sqrt(n), n / 3.0);
  // On a drift whose autocorrelation turns negative the sums cancel: never below what correlates.
  const double best =
      std::fmax(static_cast<double>(last), std::cbrt(1.5 * std::pow(curvature / spectrum, 2) * n));
  return static_cast<std::size_t>(std::lround(std::fmax(1.0, std::fmin(best, longest))));
}

}  // namespace loopbench

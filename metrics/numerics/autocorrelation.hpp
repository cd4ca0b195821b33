/// Number of independent values in a correlated series.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

namespace loopbench::metrics {

/// 1 + 2 (sum of the autocorrelations up to the first one that is no larger than chance allows: two
/// deviations of that of independent values), of numbers after subtraction of their mean. The
/// variance of their mean is larger by this factor than for independent numbers. O(n lags).
inline double integrated_autocorrelation(const std::vector<double>& values) {
  Eigen::VectorXd r =
      Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
  r.array() -= r.mean();
  const Eigen::Index n = r.size();
  const double variance = r.squaredNorm();
  double out = 1.0;
  for (Eigen::Index lag = 1; lag < n / 2 && variance > 0.0; ++lag) {
    const double rho = r.head(n - lag).dot(r.tail(n - lag)) / variance;
    if (rho < 2.0 / std::sqrt(static_cast<double>(n - lag))) break;
    out += 2.0 * rho;
  }
  return out;
}

}  // namespace loopbench::metrics

/// Likelihood of all closures together, with fitted sizes of the noise.
#pragma once

#include <vector>

#include "metrics/doctor/closure_chain.hpp"

namespace loopbench::metrics {

/// Logarithm of the likelihood of the inverted closures over that of the closures. Gaussian, for
/// the gaps of all loops with the covariance that odometry and closures cause, correlated by the
/// odometry that loops share: the drift cancels where closures connect the same sections. The
/// variances of the odometry's translation and rotation and of the closures are multiplied by the
/// factors that fit best. O(keyframes + closures^3).
double inversion_log_ratio(const std::vector<Edge>& closures, const Chain& chain);

}  // namespace loopbench::metrics

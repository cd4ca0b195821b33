/// Means, variances and cross covariance of two paired point lists, accurate far from the origin.
///
/// Source: T. Chan, G. Golub, R. LeVeque, Updating formulae and a pairwise algorithm for computing
/// sample variances, 1979.
#pragma once

#include <cstddef>

#include "datasets/core/trajectory.hpp"

namespace loopbench::metrics {

struct Moments {
  double count = 0.0;
  Vector3 reference_mean = Vector3::Zero();
  Vector3 estimate_mean = Vector3::Zero();
  /// Sums of squared distances from the means, not divided by count [m^2].
  double reference_dispersion = 0.0;
  double estimate_dispersion = 0.0;
  Matrix3 cross = Matrix3::Zero();  ///< sum of (reference - mean) * (estimate - mean)^T
};

/// Moments of paired lists of equal size. O(n), one pass: blocks that fit into the cache are
/// centred on their own mean, then merged.
Moments moments(const Trajectory& reference, const Trajectory& estimate);

}  // namespace loopbench::metrics

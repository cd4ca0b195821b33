/// The loss of riSAM, from convex to that of Geman and McClure.
#pragma once

#include <algorithm>
#include <cmath>

namespace loopbench::methods {

/// Weight of a squared Mahalanobis error `chi2` with scale `c2`: c2 (c2 + s (1 - mu)) / (c2 + s)^2
/// with s = chi2^mu. All weights are equal at mu = 0; at 1 they are those of Geman and McClure.
inline double graduated_weight(double chi2, double c2, double mu) {
  const double s = std::pow(chi2, mu);
  const double sum = c2 + s;
  return c2 * (c2 + s * (1.0 - mu)) / (sum * sum);
}

/// The next mu on the way from 0 to 1: 0.12, 0.384, 0.9648, 1.
inline double next_mu(double mu) { return std::min(1.0, mu + 1.2 * (mu + 0.1)); }

}  // namespace loopbench::methods

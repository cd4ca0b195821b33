/// The range of k standard normal draws (the studentized range with infinitely many degrees of
/// freedom), which Nemenyi's critical difference needs.
#pragma once

namespace loopbench {

/// P(range <= q) of k >= 2 draws, to 1e-10. Throws std::invalid_argument.
double range_cdf(double q, int k);

/// The q with range_cdf(q, k) = p, 0 < p < 1. Throws std::invalid_argument.
double range_quantile(double p, int k);

}  // namespace loopbench

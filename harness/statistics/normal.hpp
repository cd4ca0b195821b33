/// The standard normal distribution.
#pragma once

namespace loopbench {

/// P(Z <= z), to a few ulp in both tails.
double normal_cdf(double z);

/// The z with P(Z <= z) = p; -inf at 0, inf at 1. Throws std::invalid_argument outside of [0, 1].
double normal_quantile(double p);

}  // namespace loopbench

/// The standard normal distribution.
#pragma once

namespace loopbench::harness {

/// P(Z <= z), to a few ulp in both tails.
double normal_cdf(double z);

}  // namespace loopbench::harness

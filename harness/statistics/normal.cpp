#include "harness/statistics/normal.hpp"

#include <cmath>
#include <numbers>

namespace loopbench::harness {

double normal_cdf(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

}  // namespace loopbench::harness

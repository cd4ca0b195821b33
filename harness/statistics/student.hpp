/// Student's t distribution with an integer number of degrees of freedom.
#pragma once

#include <cstddef>

namespace loopbench::harness {

/// P(|T| >= |t|) with `freedom` >= 1 degrees of freedom: two-sided p. Absolute error below 1e-14.
/// The finite series of Abramowitz and Stegun, 26.7.3 and 26.7.4. O(freedom).
double student_p(double t, std::size_t freedom);

/// The t > 0 with student_p(t) = p, 0 < p < 1. By bisection, to rounding.
double student_quantile(double p, std::size_t freedom);

}  // namespace loopbench::harness

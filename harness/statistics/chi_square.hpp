/// The upper tail of the chi-square distribution.
#pragma once

namespace loopbench {

/// P(X >= x) with `degrees` >= 1 degrees of freedom, by the recurrence over whole degrees
/// (Abramowitz and Stegun 26.4.4, 26.4.5). 1 for x <= 0. Throws std::invalid_argument. O(degrees).
double chi_square_tail(double x, int degrees);

}  // namespace loopbench

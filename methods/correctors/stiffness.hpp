/// Closures that are nearly exact, which makes sparse normal equations singular.
#pragma once

#include "datasets/core/problem.hpp"

namespace loopbench::methods {

/// Whether a closure's information exceeds 1e6 times the largest information of the odometry, for
/// translation or rotation. A closure with a thousandth of an odometry edge's deviation takes a
/// millionth of a gap; a larger information changes the solution by less than rounding does.
/// O(edges).
bool is_stiff(const Problem& problem);

/// Returns the problem with the closures' information scaled down to that bound. Rows and columns
/// are scaled equally, so correlations do not change. O(edges).
Problem with_bounded_stiffness(const Problem& problem);

}  // namespace loopbench::methods

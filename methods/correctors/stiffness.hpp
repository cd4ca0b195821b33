/// Closures that are so certain that the equations of a sparse solver lose all digits.
#pragma once

#include "datasets/core/problem.hpp"

namespace loopbench {

/// Whether a closure's information exceeds 1e6 times the largest of the odometry, for translation
/// or rotation. A closure a thousand times as certain as one odometry edge takes a millionth of a
/// gap; what is above changes the solution less than rounding changes the equations. O(edges).
bool is_stiff(const Problem& problem);

/// The same problem, information of closures scaled down to that bound: rows and columns alike, so
/// that correlations stay. O(edges).
Problem with_bounded_stiffness(const Problem& problem);

}  // namespace loopbench

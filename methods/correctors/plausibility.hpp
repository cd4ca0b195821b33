/// Tests whether stated covariances are plausible: against the residuals of the solution computed
/// with them, and whether closures are nearly exact, which makes sparse normal equations singular.
#pragma once

#include <cstddef>

#include "datasets/core/problem.hpp"
#include "methods/report.hpp"

namespace loopbench::methods {

/// 99 % quantile of the chi-squared distribution with 3, 4, 6 or 7 degrees of freedom.
double inlier_chi2(std::size_t dof);

/// Degrees of freedom of the residuals: `dimensions` per edge beyond a spanning tree, or 0 when
/// there are no such edges.
std::size_t degrees_of_freedom(std::size_t keyframes, std::size_t edges, std::size_t dimensions);

/// Degrees of freedom of a chain with poses in SE(2) (planar) or SE(3).
std::size_t degrees_of_freedom(const Problem& problem);

/// Whether chi2 is above the 99.95 % quantile of its distribution (approximation of Wilson and
/// Hilferty 1931).
bool is_too_large(double chi2, std::size_t dof);

/// Adds the count `chi2_per_dof` [-]. If the closures cannot be judged (why_not_judged()), adds a
/// note if chi2 is outside the central 99.9 % of its distribution and chi2_per_dof differs from 1
/// by more than a factor of 4 (standard deviations wrong by a factor of 2); where they can, their
/// judgement states what is wrong. Adds nothing without degrees of freedom.
void report_chi2(double chi2, std::size_t dof, const Problem& problem, Report& report);

/// Whether a closure's information exceeds 1e6 times the largest information of the odometry, for
/// translation or rotation. A closure with a thousandth of an odometry edge's deviation takes a
/// millionth of a gap; a larger information changes the solution by less than rounding does.
/// O(edges).
bool is_stiff(const Problem& problem);

/// Returns the problem with the closures' information scaled down to that bound. Rows and columns
/// are scaled equally, so correlations do not change. O(edges).
Problem with_bounded_stiffness(const Problem& problem);

}  // namespace loopbench::methods

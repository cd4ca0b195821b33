/// The chi-squared distribution of the residuals of a problem whose stated covariances are right.
/// consensus/judgement.hpp judges whether they are right, and which closures are false.
#pragma once

#include <cstddef>

#include "datasets/core/problem.hpp"
#include "methods/report.hpp"

namespace loopbench::methods {

/// 99 % quantile of the chi-squared distribution with 3, 4, 6 or 7 degrees of freedom: the gate
/// of robust methods.
double inlier_chi2(std::size_t dof);

/// Degrees of freedom of the residuals: `dimensions` per edge beyond a spanning tree, or 0 when
/// there are no such edges.
std::size_t degrees_of_freedom(std::size_t keyframes, std::size_t edges, std::size_t dimensions);

/// Degrees of freedom of a chain with poses in SE(2) (planar) or SE(3).
std::size_t degrees_of_freedom(const Problem& problem);

/// Whether chi2 at a minimum is above the 99.95 % quantile of its distribution (approximation of
/// Wilson and Hilferty 1931): there may be a lower minimum.
bool is_unlikely(double chi2, std::size_t dof);

/// Adds the count `chi2_per_dof` [-]. Adds nothing without degrees of freedom.
void count_chi2_per_dof(double chi2, std::size_t dof, Report& report);

}  // namespace loopbench::methods

/// Tests whether the residuals of a solution are consistent with the covariances it was computed
/// with.
#pragma once

#include <cstddef>

#include "datasets/core/problem.hpp"
#include "methods/report.hpp"

namespace loopbench::methods {

/// Degrees of freedom of the residuals: `dimensions` per edge beyond a spanning tree, or 0 when
/// there are no such edges.
std::size_t freedom(std::size_t keyframes, std::size_t edges, std::size_t dimensions);

/// Degrees of freedom of a chain with poses in SE(2) (planar) or SE(3).
std::size_t freedom(const Problem& problem);

/// Whether chi2 is above the 99.95 % quantile of its distribution (approximation of Wilson and
/// Hilferty 1931).
bool is_too_large(double chi2, std::size_t freedom);

/// Adds the count `chi2_per_dof` [-]. Adds a note if chi2 is outside the central 99.9 % of its
/// distribution and chi2_per_dof differs from 1 by more than a factor of 4 (standard deviations
/// wrong by a factor of 2). Adds nothing without degrees of freedom.
void report_chi2(double chi2, std::size_t freedom, Report& report);

}  // namespace loopbench::methods

/// Whether the residuals of a solution fit the covariances it was computed with.
#pragma once

#include <cstddef>

#include "datasets/core/problem.hpp"
#include "methods/report.hpp"

namespace loopbench {

/// Degrees of freedom of the residuals: `dimensions` for each edge beyond a spanning tree. 0 when
/// there are none.
std::size_t freedom(std::size_t keyframes, std::size_t edges, std::size_t dimensions);

/// Degrees of freedom of a chain in SE(2) or SE(3).
std::size_t freedom(const Problem& problem);

/// Whether chi2 is above the 99.95 % quantile of its distribution (Wilson and Hilferty 1931).
bool is_too_large(double chi2, std::size_t freedom);

/// Adds the count `chi2_per_dof` [-] and, where it is outside the central 99.9 % of its
/// distribution and more than a factor of 4 from 1 (standard deviations off by a factor of 2), a
/// note. Adds nothing without degrees of freedom.
void report_chi2(double chi2, std::size_t freedom, Report& report);

}  // namespace loopbench

/// Variance components of a chain's odometry, estimated from its loop gaps.
#pragma once

#include "datasets/core/problem.hpp"
#include "methods/report.hpp"

namespace loopbench::methods {

/// Factors on the stated variances of all odometry edges [-].
struct VarianceFactors {
  double translation = 1.0;
  double rotation = 1.0;
};

/// Maximises the likelihood of the closure errors before correction over both factors,
///
///     c ~ N(0, A D S D A' + S_L),   D = diag(sqrt(translation) I, sqrt(rotation) I),
///
/// where S and S_L are the stated covariances of odometry and closures, times a weak prior: the
/// stated standard deviations are correct up to a factor of 10 (log-normal, one deviation).
/// Relinearises at the solution until the factors no longer change. The factors lie on a lattice
/// with a spacing of 1/4 octave in 1e-4 .. 1e4. Requires complete odometry (why_no_chain()) and at
/// least one closure. Complexity: about 50 Cholesky factorisations of size 6 closures in each of at
/// most 5 rounds. Source: Koch, Parameter Estimation and Hypothesis Testing in Linear Models, 1999,
/// section 3.6 (maximum likelihood variance components). No reference is used.
VarianceFactors variance_factors(const Problem& problem);

/// Returns the problem with D S D in place of S. O(edges).
Problem with_factors(Problem problem, const VarianceFactors& factors);

/// Returns the problem with the estimated factors. Adds the counts `factor_t` and `factor_r`,
/// factors on standard deviations.
Problem with_estimated_factors(const Problem& problem, Report& report);

}  // namespace loopbench::methods

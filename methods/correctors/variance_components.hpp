/// Variance components of a chain's odometry, estimated from what its loops leave open.
#pragma once

#include "datasets/core/problem.hpp"

namespace loopbench {

/// Factors on the stated variances of all odometry edges [-].
struct VarianceFactors {
  double translation = 1.0;
  double rotation = 1.0;
};

/// Maximises, over both factors, the likelihood of the closures' errors before correction,
///
///     c ~ N(0, A D S D A' + S_L),   D = diag(sqrt(translation) I, sqrt(rotation) I),
///
/// with S and S_L the stated covariances of odometry and closures, times a weak prior: either
/// standard deviation is right to a factor of 10 (log-normal, one deviation). Relinearised at the
/// solution until the factors no longer change. Factors lie on a lattice of 1/4 octave in 1e-4 ..
/// 1e4. Needs a whole chain (chain_fault()) and at least one closure.
/// Complexity: some 50 Cholesky factorisations of size 6 closures in each of at most 5 rounds.
/// Source: Koch, Parameter estimation and hypothesis testing in linear models, 1999, 3.6 (variance
/// components by maximum likelihood). No reference is used.
VarianceFactors variance_factors(const Problem& problem);

/// The problem with D S D in place of S. O(edges).
Problem with_factors(Problem problem, const VarianceFactors& factors);

}  // namespace loopbench

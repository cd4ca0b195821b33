/// Posterior of the noise model given the loop gaps, by Markov chain Monte Carlo.
#pragma once

#include <cstdint>
#include <vector>

#include "methods/correctors/motion_drift/evidence.hpp"
#include "methods/correctors/motion_drift/prior.hpp"

namespace loopbench::methods {

struct Sampling {
  int draws = 256;
  int steps = 8;      ///< steps between draws
  int burn_in = 120;  ///< steps before the first draw
  std::int64_t seed = 1;
};

struct MotionPosterior {
  std::vector<MotionModel> draws;
  std::vector<double> probabilities;  ///< posterior of the hypotheses: shares of the draws
  MotionModel centre;         ///< geometric mean of the draws of the most probable hypothesis
  double log_evidence = 0.0;  ///< log evidence of the gaps, mean over the draws
};

/// Draws from the product of the prior and exp(log_evidence()). Each step redraws the hypothesis
/// (Metropolis) and then takes one step of elliptical slice sampling, which has no parameters: from
/// u and a random normal v to the first tried point above the threshold on the ellipse through
/// both. Bit-identical for equal seeds. Throws std::runtime_error if the covariance of the gaps is
/// not positive definite at u = 0. O(steps (gaps^3 + gaps^2 terms)), with about six points per
/// step. Source: Murray, Adams, MacKay, Elliptical slice sampling, AISTATS 2010.
MotionPosterior posterior_of(const MotionPrior& prior,
                             const Evidence& evidence,
                             const Sampling& sampling);

}  // namespace loopbench::methods

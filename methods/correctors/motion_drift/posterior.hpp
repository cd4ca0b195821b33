/// Error models drawn by how well they explain the gaps that the loops leave.
#pragma once

#include <cstdint>
#include <vector>

#include "methods/correctors/motion_drift/evidence.hpp"
#include "methods/correctors/motion_drift/prior.hpp"

namespace loopbench::methods {

struct Sampling {
  int draws = 256;
  int steps = 8;      ///< from draw to draw
  int warm_up = 120;  ///< steps before the first
  std::int64_t seed = 1;
};

struct MotionPosterior {
  std::vector<MotionModel> draws;
  std::vector<double> probabilities;  ///< of the hypotheses, given the gaps: parts of the draws
  MotionModel centre;         ///< of the likeliest: values whose logarithms are its draws' mean
  double log_evidence = 0.0;  ///< of the gaps, mean over the draws
};

/// Draws from prior times log_evidence(). Each step tries a fresh hypothesis, all else as it is
/// (Metropolis), then samples by elliptical slices, which have nothing to tune: from u and a fresh
/// normal v to the first point tried on the ellipse through both that is likely enough. The same
/// seed, the same bits. Throws std::runtime_error when the model at u = 0 gives the gaps no
/// density. O(steps (gaps^3 + gaps^2 terms)) with some six points tried a step.
/// Source: Murray, Adams, MacKay, Elliptical slice sampling, AISTATS 2010.
MotionPosterior posterior_of(const MotionPrior& prior,
                             const Evidence& evidence,
                             const Sampling& sampling);

}  // namespace loopbench::methods

/// The motion-dependent error model: a list of variances, each with what it grows with.
#pragma once

#include <string>
#include <vector>

#include "methods/correctors/looped_chain.hpp"
#include "methods/correctors/motion_drift/motion.hpp"

namespace loopbench {

/// Which half of a twist a term is about.
enum class Half { translation, rotation };

/// Noise: fresh in every edge, of variance value * grown on each axis. Drift: one unknown rate a
/// body axis all along the chain, rate ~ N(0, value), error = rate * grown. Stated: value is a
/// factor on what the odometry edges state, added to the noise. Closures: value is a factor on
/// their stated covariance.
enum class Cause { noise, drift, stated, closures };

struct Term {
  Cause cause;
  Half half;           ///< not used by stated
  Growth growth;       ///< of noise and drift
  double value = 0.0;  ///< a variance or factor, never negative
  bool given = false;  ///< value was stated in the options, not guessed
  int axis = -1;       ///< drift only: 0, 1, 2 of the half; -1: each of them
};

/// "noise.r.per_metre": as the options name it; drift of one axis has that appended: ".x".
std::string name_of(const Term& term);

using MotionModel = std::vector<Term>;

/// What the model says about each edge and closure of the problem. O((edges + closures) terms).
ChainBelief belief_of(const MotionModel& model,
                      const Problem& problem,
                      const std::vector<EdgeMotion>& motions);

}  // namespace loopbench

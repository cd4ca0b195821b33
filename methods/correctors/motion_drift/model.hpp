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
/// axis all along the chain, rate ~ N(0, value), error = rate * grown. Closures: value is a factor
/// on the stated covariance.
enum class Cause { noise, drift, closures };

struct Term {
  Cause cause;
  Half half;
  Growth growth;       ///< not used by closures
  double value = 0.0;  ///< a variance or factor, never negative
  bool given = false;  ///< value was stated, not guessed
};

/// "noise.r.per_metre": as the options name it.
std::string name_of(const Term& term);

using MotionModel = std::vector<Term>;

/// What the model says about each edge and closure of the problem. O((edges + closures) terms).
ChainBelief belief_of(const MotionModel& model,
                      const Problem& problem,
                      const std::vector<EdgeMotion>& motions);

}  // namespace loopbench

/// The motion-dependent noise model: a list of variances, each with its regressor.
#pragma once

#include <string>
#include <vector>

#include "methods/correctors/looped_chain.hpp"
#include "methods/correctors/motion_drift/motion.hpp"

namespace loopbench::methods {

/// Component of a twist that a term describes.
enum class Component { translation, rotation };

/// noise: independent in every edge, with variance value * regressor on each axis. drift: one
/// unknown constant rate per body axis along the whole chain, rate ~ N(0, value), error = rate *
/// regressor. stated: value is a factor on the stated covariance of the odometry edges, added to
/// the noise. closures: value is a factor on the stated covariance of the closures.
enum class TermKind { noise, drift, stated, closures };

struct Term {
  TermKind kind;
  Component component;  ///< ignored for stated
  Regressor regressor;  ///< for noise and drift only
  double value = 0.0;   ///< variance or factor, >= 0
  bool given = false;   ///< the value was set by an option
  int axis = -1;        ///< drift only: 0, 1, 2 for one axis of the component; -1 for all three
};

/// Keeps the axes of the term and sets the others to 0.
Twist on_axes(const Term& term, const Twist& all);

/// Option name of a term, for example "noise.r.per_metre". The name of a single-axis drift ends in
/// ".x", ".y" or ".z".
std::string name_of(const Term& term);

using MotionModel = std::vector<Term>;

/// Returns the noise model of every edge and closure of the problem. O((edges + closures) terms).
NoiseModel noise_model_of(const MotionModel& model,
                          const Problem& problem,
                          const std::vector<EdgeMotion>& motions);

}  // namespace loopbench::methods

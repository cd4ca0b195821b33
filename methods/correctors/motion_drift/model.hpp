/// The motion-dependent noise model: a list of variances, each with its regressor. Regressors are
/// functions of the duration, length and rotation angle of an odometry edge.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "datasets/core/problem.hpp"
#include "methods/correctors/looped_chain.hpp"

namespace loopbench::methods {

/// Regressor of an error variance or of a drift.
enum class Regressor { edge, time, distance, rotation, speed };
inline constexpr std::array kRegressors{
    Regressor::edge, Regressor::time, Regressor::distance, Regressor::rotation, Regressor::speed};

/// "edge", "second", "metre", "radian", "speed": the suffix of the options `per_...`.
inline const char* name_of(Regressor regressor) {
  static constexpr const char* kNames[] = {"edge", "second", "metre", "radian", "speed"};
  return kNames[static_cast<std::size_t>(regressor)];
}

struct EdgeMotion {
  double seconds = 0.0;
  double metres = 0.0;   ///< length of the measured translation
  double radians = 0.0;  ///< angle of the measured rotation
  /// Per regressor, the fraction of the edge over which drift is extrapolated: see
  /// limit_drift().
  std::array<double, kRegressors.size()> drift_part{1.0, 1.0, 1.0, 1.0, 1.0};
};

inline std::vector<EdgeMotion> motions(const Problem& problem) {
  std::vector<EdgeMotion> out;
  out.reserve(problem.odometry.size());
  for (const Edge& edge : problem.odometry) {
    EdgeMotion& motion = out.emplace_back();
    motion.seconds = problem.keyframes[edge.to].stamp - problem.keyframes[edge.from].stamp;
    motion.metres = edge.from_from_to.translation.norm();
    motion.radians = log_so3(edge.from_from_to.rotation).norm();
  }
  return out;
}

/// Value of the regressor for one edge: 1, dt, d, |dtheta| or (d / dt)^2 dt.
inline double regressor_value(Regressor with, const EdgeMotion& motion) {
  switch (with) {
    case Regressor::edge:
      return 1.0;
    case Regressor::time:
      return motion.seconds;
    case Regressor::distance:
      return motion.metres;
    case Regressor::rotation:
      return motion.radians;
    case Regressor::speed:
      return motion.metres * motion.metres / motion.seconds;
  }
  return 0.0;
}

/// Value of the regressor for drift, limited by drift_part.
inline double drift_regressor_value(Regressor with, const EdgeMotion& motion) {
  return motion.drift_part[static_cast<std::size_t>(with)] * regressor_value(with, motion);
}

/// Sets `drift_part` of every edge. Loops measure drift only along the edges that they enclose. For
/// each regressor (edge, time, distance, rotation, speed) the reach is `reach` times the sum of
/// that regressor over all enclosed edges. Edges outside all loops have full drift while the
/// regressor accumulated between them and the nearest enclosed edge is within the reach, and no
/// drift beyond it. A loop of ten seconds therefore does not determine the drift of an hour outside
/// it. O(edges + closures).
void limit_drift(std::vector<EdgeMotion>& motions, const Problem& problem, double reach);

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

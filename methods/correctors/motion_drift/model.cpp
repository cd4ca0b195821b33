#include "methods/correctors/motion_drift/model.hpp"

#include <Eigen/LU>
#include <cmath>

namespace loopbench::methods {
namespace {

/// Lower bound on each edge's variance, as a fraction of the chain's mean variance. An edge without
/// motion would otherwise have a singular covariance.
constexpr double kFloor = 1e-9;

/// `value` on the axes of the term, 0 elsewhere.
Twist on_axes(const Term& term, double value) {
  Twist out = Twist::Zero();
  const Eigen::Index at = term.half == Half::translation ? 0 : 3;
  if (term.axis < 0) {
    out.segment<3>(at).setConstant(value);
  } else {
    out[at + term.axis] = value;
  }
  return out;
}

void add_odometry(ChainBelief& noise_model,
                  const MotionModel& model,
                  const Problem& problem,
                  const std::vector<EdgeMotion>& motions) {
  noise_model.covariance.assign(motions.size(), Matrix6::Zero());
  for (const Term& term : model) {
    for (std::size_t i = 0; i < motions.size(); ++i) {
      if (term.cause == Cause::noise) {
        noise_model.covariance[i].diagonal() +=
            on_axes(term, term.value * grown(term.growth, motions[i]));
      } else if (term.cause == Cause::stated) {
        noise_model.covariance[i] += term.value * problem.odometry[i].information.inverse();
      }
    }
  }
  Twist mean = Twist::Zero();
  for (const Matrix6& c : noise_model.covariance) {
    mean += c.diagonal() / static_cast<double>(motions.size());
  }
  for (Matrix6& c : noise_model.covariance) {
    c.diagonal() = c.diagonal().cwiseMax(kFloor * mean);
    noise_model.information.push_back(c.inverse());
  }
}

}  // namespace

std::string name_of(const Term& term) {
  const std::string half = term.half == Half::translation ? "t" : "r";
  if (term.cause == Cause::closures) return "closures." + half;
  if (term.cause == Cause::stated) return "stated";
  const std::string cause = term.cause == Cause::noise ? "noise." : "drift.";
  static constexpr const char* kAxes[] = {"", ".x", ".y", ".z"};
  return cause + half + ".per_" + name_of(term.growth) + kAxes[term.axis + 1];
}

ChainBelief belief_of(const MotionModel& model,
                      const Problem& problem,
                      const std::vector<EdgeMotion>& motions) {
  ChainBelief out;
  add_odometry(out, model, problem, motions);
  Twist scale = Twist::Ones();  // factor on the closures' standard deviations
  for (const Term& term : model) {
    if (term.cause != Cause::closures) continue;
    const double deviation = std::sqrt(term.value);
    (term.half == Half::translation ? scale.head<3>() : scale.tail<3>()).setConstant(deviation);
  }
  for (const Edge& loop : problem.closures) {
    const Twist inverse_scale = scale.cwiseInverse();
    out.closure_covariance.push_back(scale.asDiagonal() * loop.information.inverse() *
                                     scale.asDiagonal());
    out.closure_information.push_back(inverse_scale.asDiagonal() * loop.information *
                                      inverse_scale.asDiagonal());
  }
  for (const Growth growth : kGrowths) {
    Twist rates = Twist::Zero();
    for (const Term& term : model) {
      if (term.cause == Cause::drift && term.growth == growth) rates += on_axes(term, term.value);
    }
    if (rates.isZero(0.0)) continue;
    ChainBelief::Drift drift{{}, rates};
    drift.shape.reserve(motions.size());
    for (const EdgeMotion& motion : motions) {
      drift.shape.push_back(Twist::Constant(drifted(growth, motion)));
    }
    out.drift.push_back(std::move(drift));
  }
  return out;
}

}  // namespace loopbench::methods

#include "methods/correctors/motion_drift/model.hpp"

#include <Eigen/LU>
#include <cmath>

namespace loopbench {
namespace {

/// No edge's variance falls below this part of the chain's mean: an edge that did not move would
/// have none, and no inverse.
constexpr double kFloor = 1e-9;

/// `value` on the axes the term is about.
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

void add_odometry(ChainBelief& belief,
                  const MotionModel& model,
                  const Problem& problem,
                  const std::vector<EdgeMotion>& motions) {
  belief.covariance.assign(motions.size(), Matrix6::Zero());
  for (const Term& term : model) {
    for (std::size_t i = 0; i < motions.size(); ++i) {
      if (term.cause == Cause::noise) {
        belief.covariance[i].diagonal() +=
            on_axes(term, term.value * grown(term.growth, motions[i]));
      } else if (term.cause == Cause::stated) {
        belief.covariance[i] += term.value * problem.odometry[i].information.inverse();
      }
    }
  }
  Twist mean = Twist::Zero();
  for (const Matrix6& c : belief.covariance) {
    mean += c.diagonal() / static_cast<double>(motions.size());
  }
  for (Matrix6& c : belief.covariance) {
    c.diagonal() = c.diagonal().cwiseMax(kFloor * mean);
    belief.information.push_back(c.inverse());
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
  Twist stretch = Twist::Ones();  // of a closure's standard deviations
  for (const Term& term : model) {
    if (term.cause != Cause::closures) continue;
    const double by = std::sqrt(term.value);
    (term.half == Half::translation ? stretch.head<3>() : stretch.tail<3>()).setConstant(by);
  }
  for (const Edge& loop : problem.closures) {
    const Twist shrink = stretch.cwiseInverse();
    out.closure_covariance.push_back(stretch.asDiagonal() * loop.information.inverse() *
                                     stretch.asDiagonal());
    out.closure_information.push_back(shrink.asDiagonal() * loop.information * shrink.asDiagonal());
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

}  // namespace loopbench

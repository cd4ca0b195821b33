#include "methods/correctors/motion_drift/model.hpp"

#include <cmath>

namespace loopbench {
namespace {

/// No edge's variance falls below this part of the chain's mean: an edge that did not move would
/// have none, and no inverse.
constexpr double kFloor = 1e-9;

Twist on_half(Half half, double value) {
  return half == Half::translation ? twist(Vector3::Constant(value), Vector3::Zero())
                                   : twist(Vector3::Zero(), Vector3::Constant(value));
}

}  // namespace

std::string name_of(const Term& term) {
  const std::string half = term.half == Half::translation ? "t" : "r";
  if (term.cause == Cause::closures) return "closures." + half;
  const std::string source = term.cause == Cause::noise ? "noise." : "drift.";
  return source + half + ".per_" + name_of(term.growth);
}

ChainBelief belief_of(const MotionModel& model,
                      const Problem& problem,
                      const std::vector<EdgeMotion>& motions) {
  std::vector<Twist> variance(motions.size(), Twist::Zero());
  Twist mean = Twist::Zero();
  for (const Term& term : model) {
    if (term.cause != Cause::noise || term.value == 0.0) continue;
    for (std::size_t i = 0; i < motions.size(); ++i) {
      variance[i] += on_half(term.half, term.value * grown(term.growth, motions[i]));
    }
  }
  for (const Twist& v : variance) mean += v / static_cast<double>(variance.size());

  ChainBelief out;
  out.covariance.reserve(variance.size());
  out.information.reserve(variance.size());
  for (const Twist& v : variance) {
    const Twist kept = v.cwiseMax(kFloor * mean);
    out.covariance.emplace_back(kept.asDiagonal());
    out.information.emplace_back(kept.cwiseInverse().asDiagonal());
  }
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
      if (term.cause == Cause::drift && term.growth == growth) {
        rates += on_half(term.half, term.value);
      }
    }
    if (rates.isZero(0.0)) continue;
    ChainBelief::Drift drift{{}, rates};
    drift.shape.reserve(motions.size());
    for (const EdgeMotion& motion : motions) {
      drift.shape.push_back(Twist::Constant(grown(growth, motion)));
    }
    out.drift.push_back(std::move(drift));
  }
  return out;
}

}  // namespace loopbench

#include "methods/correctors/motion_drift/posterior.hpp"

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

namespace loopbench {
namespace {

constexpr double kFullTurn = 2.0 * std::numbers::pi;

/// Draws that are the same with every standard library.
class SliceDraws {
 public:
  explicit SliceDraws(std::int64_t seed) : bits_(static_cast<std::uint64_t>(seed)) {}

  /// In (0, 1).
  double uniform() { return (static_cast<double>(bits_() >> 11) + 0.5) * 0x1p-53; }

  /// Box and Muller.
  Eigen::VectorXd normal(Eigen::Index size) {
    Eigen::VectorXd out(size);
    for (Eigen::Index i = 0; i < size; ++i) {
      const double radius = std::sqrt(-2.0 * std::log(uniform()));
      out[i] = radius * std::cos(kFullTurn * uniform());
    }
    return out;
  }

 private:
  std::mt19937_64 bits_;
};

struct SlicePoint {
  Eigen::VectorXd unknowns;
  double log_evidence;
};

void slice_step(SlicePoint& at,
                const MotionPrior& prior,
                const Evidence& evidence,
                SliceDraws& draw) {
  const Eigen::VectorXd other = draw.normal(prior.unknowns);
  const double enough = at.log_evidence + std::log(draw.uniform());
  double angle = kFullTurn * draw.uniform();
  double low = angle - kFullTurn;
  double high = angle;
  // The bracket shrinks by a third a try towards where we stand, which is likely enough.
  for (int tries = 0; tries < 100; ++tries) {
    const Eigen::VectorXd there = std::cos(angle) * at.unknowns + std::sin(angle) * other;
    const double value = log_evidence(model_at(prior, there), evidence);
    if (value > enough) {
      at = {there, value};
      return;
    }
    (angle < 0.0 ? low : high) = angle;
    angle = low + (high - low) * draw.uniform();
  }
}

}  // namespace

MotionPosterior posterior_of(const MotionPrior& prior,
                             const Evidence& evidence,
                             const Sampling& sampling,
                             const Eigen::VectorXd& start) {
  SliceDraws draw(sampling.seed);
  SlicePoint at{start, log_evidence(model_at(prior, start), evidence)};
  if (!std::isfinite(at.log_evidence)) {
    throw std::runtime_error("the covariance of the loop gaps is not positive definite");
  }
  for (int i = 0; i < sampling.warm_up; ++i) slice_step(at, prior, evidence, draw);
  MotionPosterior out;
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(prior.unknowns);
  for (int i = 0; i < sampling.draws; ++i) {
    for (int s = 0; s < sampling.steps; ++s) slice_step(at, prior, evidence, draw);
    out.draws.push_back(model_at(prior, at.unknowns));
    mean += at.unknowns / sampling.draws;
    out.log_evidence += at.log_evidence / sampling.draws;
  }
  out.centre = model_at(prior, mean);
  out.last = at.unknowns;
  return out;
}

}  // namespace loopbench

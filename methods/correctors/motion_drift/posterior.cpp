#include "methods/correctors/motion_drift/posterior.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

namespace loopbench::methods {
namespace {

constexpr double kFullTurn = 2.0 * std::numbers::pi;

/// Random draws that do not depend on the standard library.
class SliceDraws {
 public:
  explicit SliceDraws(std::int64_t seed) : bits_(static_cast<std::uint64_t>(seed)) {}

  /// Uniform in (0, 1).
  double uniform() { return (static_cast<double>(bits_() >> 11) + 0.5) * 0x1p-53; }

  /// Standard normal, by the Box-Muller transform.
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
  const double threshold = at.log_evidence + std::log(draw.uniform());
  double angle = kFullTurn * draw.uniform();
  double low = angle - kFullTurn;
  double high = angle;
  // Each rejection shrinks the bracket towards the current point, which exceeds the threshold.
  for (int tries = 0; tries < 100; ++tries) {
    const Eigen::VectorXd there = std::cos(angle) * at.unknowns + std::sin(angle) * other;
    const double value = log_evidence(model_at(prior, there), evidence);
    if (value > threshold) {
      at = {there, value};
      return;
    }
    (angle < 0.0 ? low : high) = angle;
    angle = low + (high - low) * draw.uniform();
  }
}

/// Metropolis step that redraws the hypothesis only.
void choice_step(SlicePoint& at,
                 const MotionPrior& prior,
                 const Evidence& evidence,
                 SliceDraws& draw) {
  Eigen::VectorXd there = at.unknowns;
  there[0] = draw.normal(1)[0];
  const double threshold = at.log_evidence + std::log(draw.uniform());
  const double value = log_evidence(model_at(prior, there), evidence);
  if (value > threshold) at = {there, value};
}

}  // namespace

MotionPosterior posterior_of(const MotionPrior& prior,
                             const Evidence& evidence,
                             const Sampling& sampling) {
  SliceDraws draw(sampling.seed);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(prior.unknowns);
  SlicePoint at{zero, log_evidence(model_at(prior, zero), evidence)};
  if (!std::isfinite(at.log_evidence)) {
    throw std::runtime_error("the covariance of the loop gaps is not positive definite");
  }
  const auto move = [&](int steps) {
    for (int i = 0; i < steps; ++i) {
      if (prior.hypotheses.size() > 1) choice_step(at, prior, evidence, draw);
      slice_step(at, prior, evidence, draw);
    }
  };
  move(sampling.burn_in);
  MotionPosterior out;
  out.probabilities.resize(prior.hypotheses.size(), 0.0);
  std::vector<Eigen::VectorXd> sums(prior.hypotheses.size(), zero);
  for (int i = 0; i < sampling.draws; ++i) {
    move(sampling.steps);
    const std::size_t chosen = hypothesis_at(prior, at.unknowns);
    out.draws.push_back(model_at(prior, at.unknowns));
    out.probabilities[chosen] += 1.0 / sampling.draws;
    sums[chosen] += at.unknowns / sampling.draws;
    out.log_evidence += at.log_evidence / sampling.draws;
  }
  const auto likeliest = static_cast<std::size_t>(std::ranges::max_element(out.probabilities) -
                                                  out.probabilities.begin());
  out.centre = model_at(prior, sums[likeliest] / out.probabilities[likeliest]);
  return out;
}

}  // namespace loopbench::methods

#include <gtest/gtest.h>

#include "methods/correctors/chain.hpp"
#include "methods/correctors/motion_drift/posterior.hpp"
#include "tests/support/problems.hpp"

namespace loopbench::motion_drift_posterior_test {

using namespace methods;

namespace {

/// One gap of 2 explained by one term with median variance 1 and dispersion 1.5.
struct OneGap {
  MotionPrior prior{{{.medians = {{TermKind::noise, Component::translation, Regressor::edge, 1.0}},
                      .loadings = {{{1, 1.5}}}}},
                    2};
  Evidence evidence{{0}, Eigen::VectorXd::Constant(1, 2.0), {Eigen::MatrixXd::Ones(1, 1)}};
};

TEST(MotionDriftPosterior, SamplesMatchTheIntegratedPosteriorOfAVariance) {
  const OneGap one;
  double mass = 0.0;
  double mean = 0.0;
  double square = 0.0;
  for (double u = -6.0; u <= 6.0; u += 0.01) {
    const double density = std::exp(
        -0.5 * u * u + log_evidence(model_at(one.prior, Eigen::Vector2d(0.0, u)), one.evidence));
    mass += density;
    mean += density * u;
    square += density * u * u;
  }
  mean /= mass;
  const double deviation = std::sqrt(square / mass - mean * mean);
  const MotionPosterior drawn = posterior_of(one.prior, one.evidence, {.draws = 4000, .steps = 3});
  double sum = 0.0;
  double squares = 0.0;
  for (const MotionModel& model : drawn.draws) {
    const double u = std::log(model[0].value) / 1.5;
    sum += u / 4000.0;
    squares += u * u / 4000.0;
  }
  EXPECT_NEAR(sum, mean, 5.0 * deviation / std::sqrt(4000.0));
  EXPECT_NEAR(std::sqrt(squares - sum * sum), deviation, 0.06 * deviation);
  EXPECT_NEAR(std::log(drawn.centre[0].value), 1.5 * sum, 1e-9);
}

TEST(MotionDriftPosterior, ZeroSpreadKeepsTheMedianAndASingularCovarianceThrows) {
  OneGap one;
  one.prior.hypotheses[0].loadings[0][0].coefficient = 0.0;
  const MotionPosterior drawn = posterior_of(one.prior, one.evidence, {.draws = 5});
  for (const MotionModel& model : drawn.draws) EXPECT_DOUBLE_EQ(model[0].value, 1.0);
  one.prior.hypotheses[0].medians[0].value = 0.0;
  EXPECT_THROW(posterior_of(one.prior, one.evidence, {}), std::runtime_error);
}

TEST(MotionDriftPosterior, HypothesisProbabilitiesFollowBayesRule) {
  // Variance 1 or 4 with the prior odds one to three, and a gap of 2.
  OneGap two;
  two.prior.hypotheses[0].loadings[0][0].coefficient = 0.0;
  two.prior.hypotheses.push_back(two.prior.hypotheses[0]);
  two.prior.hypotheses[0].probability = 0.25;
  two.prior.hypotheses[1].probability = 0.75;
  two.prior.hypotheses[1].medians[0].value = 4.0;
  const double first = 0.25 * std::exp(-2.0);
  const double second = 0.75 * std::exp(-0.5) / 2.0;
  const MotionPosterior drawn = posterior_of(two.prior, two.evidence, {.draws = 4000, .steps = 3});
  EXPECT_NEAR(drawn.probabilities[0], first / (first + second), 0.03);
  EXPECT_NEAR(drawn.probabilities[0] + drawn.probabilities[1], 1.0, 1e-9);
  EXPECT_DOUBLE_EQ(drawn.centre[0].value, 4.0);
}

TEST(MotionDriftPrior, AsStatedHasOneFactorAndTheLastHypothesisHasAllTerms) {
  const Problem problem = test::hand_held();
  const Eigen::VectorXd gap = LoopedChain(problem, stated_noise_model(problem)).linearise().gap;
  const MotionModel terms{{TermKind::noise, Component::rotation, Regressor::time},
                          {TermKind::stated, Component::rotation, Regressor::edge},
                          {TermKind::drift, Component::rotation, Regressor::time, 0.0, false, 2},
                          {TermKind::closures, Component::translation, Regressor::edge, 1.0}};
  const MotionPrior prior = prior_of(terms, {}, problem, motions(problem), gap);
  ASSERT_EQ(prior.hypotheses.size(), 6u);
  double probabilities = 0.0;
  for (const MotionPrior::Hypothesis& one : prior.hypotheses) probabilities += one.probability;
  EXPECT_NEAR(probabilities, 1.0, 1e-12);
  for (const Term& term : prior.hypotheses.back().medians) EXPECT_GT(term.value, 0.0);

  Eigen::VectorXd u = Eigen::VectorXd::LinSpaced(prior.unknowns, -1.0, 1.0);
  u[0] = -5.0;  // the first hypothesis: covariances as stated, no drift
  ASSERT_EQ(hypothesis_at(prior, u), 0u);
  const MotionModel model = model_at(prior, u);
  EXPECT_EQ(model[0].value, 0.0);
  EXPECT_GT(model[1].value, 0.0);
  EXPECT_EQ(model[2].value, 0.0);
  EXPECT_DOUBLE_EQ(model[3].value, model[1].value);
  u[0] = 5.0;
  EXPECT_EQ(hypothesis_at(prior, u), 5u);
}

TEST(MotionDriftPrior, MediansFollowSteadyAfter) {
  const Problem problem = test::planar();
  const std::vector<EdgeMotion> edge_motions = motions(problem);
  const Eigen::VectorXd gap = LoopedChain(problem, stated_noise_model(problem)).linearise().gap;
  const MotionModel terms{{TermKind::noise, Component::rotation, Regressor::time},
                          {TermKind::drift, Component::rotation, Regressor::time, 0.0, false, 2}};
  double seconds = 0.0;  // mean loop duration
  double squared = 0.0;  // mean squared loop duration
  for (const Edge& loop : problem.closures) {
    const double duration = problem.keyframes[loop.to].stamp - problem.keyframes[loop.from].stamp;
    seconds += duration / static_cast<double>(problem.closures.size());
    squared += duration * duration / static_cast<double>(problem.closures.size());
  }
  const MotionPrior prior =
      prior_of(terms, {.drift_after = 2.0 * seconds}, problem, edge_motions, gap);
  // Half as much drift as noise in squared angle at the loop ends.
  const MotionModel& medians = prior.hypotheses.back().medians;
  EXPECT_NEAR(medians[1].value * squared, 0.5 * medians[0].value * seconds, 1e-12);
}

}  // namespace
}  // namespace loopbench::motion_drift_posterior_test

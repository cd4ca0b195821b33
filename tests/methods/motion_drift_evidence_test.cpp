#include <gtest/gtest.h>

#include <Eigen/LU>
#include <numbers>

#include "methods/correctors/chain.hpp"
#include "methods/correctors/motion_drift/mean_errors.hpp"
#include "methods/correctors/motion_drift/posterior.hpp"
#include "tests/support/problems.hpp"
#include "tests/support/random_chain.hpp"

namespace loopbench {
namespace {

MotionModel every_term() {
  MotionModel out;
  double value = 0.01;
  for (const Half half : {Half::translation, Half::rotation}) {
    for (const Growth growth : kGrowths) {
      out.push_back({Cause::noise, half, growth, value});
      out.push_back({Cause::drift, half, growth, value *= 0.9});
    }
    out.push_back({Cause::closures, half, Growth::edge, 1.5});
  }
  out.push_back({Cause::drift, Half::rotation, Growth::time, 0.003, false, 1});
  out.push_back({Cause::stated, Half::rotation, Growth::edge, 0.4});
  return out;
}

/// All closures' errors when every edge's error is as given.
Eigen::VectorXd closure_errors(const Problem& problem, const std::vector<Twist>& errors) {
  std::vector<Pose> poses{problem.keyframes[0].world_from_body};
  for (std::size_t i = 0; i < errors.size(); ++i) {
    poses.push_back(poses[i] * problem.odometry[i].from_from_to * exp_se3(errors[i]));
  }
  Eigen::VectorXd out(static_cast<Eigen::Index>(6 * problem.closures.size()));
  for (std::size_t k = 0; k < problem.closures.size(); ++k) {
    const Edge& loop = problem.closures[k];
    out.segment<6>(static_cast<Eigen::Index>(6 * k)) =
        edge_error(loop, poses[loop.from], poses[loop.to]);
  }
  return out;
}

struct Dense {
  Eigen::MatrixXd A;  ///< of all closures by all edges, by finite differences
  Eigen::MatrixXd S;  ///< prior covariance of all edges' errors, drift and noise written out
};

Dense dense(const MotionModel& model, const Problem& problem) {
  const std::vector<EdgeMotion> moved = motions(problem);
  const auto n = static_cast<Eigen::Index>(6 * moved.size());
  Dense out{Eigen::MatrixXd(6 * static_cast<Eigen::Index>(problem.closures.size()), n),
            Eigen::MatrixXd::Zero(n, n)};
  for (Eigen::Index column = 0; column < n; ++column) {
    const auto moved_by = [&](double by) {
      std::vector<Twist> errors(moved.size(), Twist::Zero());
      errors[static_cast<std::size_t>(column / 6)][column % 6] = by;
      return closure_errors(problem, errors);
    };
    out.A.col(column) = (moved_by(1e-6) - moved_by(-1e-6)) / 2e-6;
  }
  for (const Term& term : model) {
    if (term.cause == Cause::closures) continue;
    if (term.cause == Cause::stated) {
      for (Eigen::Index i = 0; i < n / 6; ++i) {
        out.S.block<6, 6>(6 * i, 6 * i) +=
            term.value * problem.odometry[static_cast<std::size_t>(i)].information.inverse();
      }
      continue;
    }
    for (Eigen::Index i = 0; i < n / 6; ++i) {
      for (Eigen::Index j = 0; j < n / 6; ++j) {
        if (term.cause == Cause::noise && i != j) continue;
        const double a = grown(term.growth, moved[static_cast<std::size_t>(i)]);
        const double b = grown(term.growth, moved[static_cast<std::size_t>(j)]);
        const double entry = term.value * (term.cause == Cause::noise ? a : a * b);
        const Eigen::Index half = term.half == Half::translation ? 0 : 3;
        for (Eigen::Index axis = half; axis < half + 3; ++axis) {
          if (term.axis >= 0 && axis != half + term.axis) continue;
          out.S(6 * i + axis, 6 * j + axis) += entry;
        }
      }
    }
  }
  return out;
}

TEST(MotionDriftEvidence, EqualsTheDensityOfTheGapsComputedDensely) {
  Problem problem = test::walk(2, 12, 0.05);
  for (Edge& loop : problem.closures) {  // halves that do not mix, so factors are exact
    loop.information.block<3, 3>(0, 3).setZero();
    loop.information.block<3, 3>(3, 0).setZero();
  }
  const MotionModel model = every_term();
  const LoopedChain chain(problem, stated_belief(problem));
  const Evidence evidence = evidence_of(model, chain, problem, motions(problem), {0, 1, 2});

  const Dense by_hand = dense(model, problem);
  Eigen::MatrixXd C = by_hand.A * by_hand.S * by_hand.A.transpose();
  for (std::size_t k = 0; k < problem.closures.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(6 * k);
    C.block<6, 6>(at, at) += 1.5 * problem.closures[k].information.inverse();
  }
  const Eigen::VectorXd gap =
      closure_errors(problem, std::vector<Twist>(problem.odometry.size(), Twist::Zero()));
  EXPECT_TRUE(evidence.gap.isApprox(gap, 1e-9));
  const double wanted = -0.5 * (gap.dot(C.inverse() * gap) + std::log(C.determinant()) +
                                static_cast<double>(gap.size()) * std::log(2.0 * std::numbers::pi));
  EXPECT_NEAR(log_evidence(model, evidence), wanted, 1e-5);
}

TEST(MotionDriftEvidence, SeesOnlyThePlaneOfAPlanarProblemAndOnlyChosenClosures) {
  const Problem problem = test::planar();
  const LoopedChain chain(problem, stated_belief(problem));
  const MotionModel model = every_term();
  const Evidence all = evidence_of(model, chain, problem, motions(problem), {0, 1});
  EXPECT_EQ(all.gap.size(), 6);
  const Evidence one = evidence_of(model, chain, problem, motions(problem), {1});
  ASSERT_EQ(one.gap.size(), 3);
  EXPECT_TRUE(one.gap.isApprox(all.gap.tail<3>()));
  for (std::size_t j = 0; j < model.size(); ++j) {
    EXPECT_TRUE(one.shares[j].isApprox(all.shares[j].bottomRightCorner<3, 3>())) << j;
  }
}

TEST(MotionDriftEvidence, OneSolveIsTheConditionalMeanOfTheModel) {
  // Errors so small that the problem is linear: e = -S A' (A S A' + S_L)^-1 c, drift written out.
  const Problem problem = test::walk(4, 10, 1e-6);
  const MotionModel model = every_term();
  const Dense by_hand = dense(model, problem);
  const ChainBelief belief = belief_of(model, problem, motions(problem));
  LoopedChain chain(problem, belief);
  for (int i = 0; i < 10; ++i) chain.step();
  Eigen::MatrixXd C = by_hand.A * by_hand.S * by_hand.A.transpose();
  for (std::size_t k = 0; k < problem.closures.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(6 * k);
    C.block<6, 6>(at, at) += belief.closure_covariance[k];
  }
  const std::vector<Twist> none(problem.odometry.size(), Twist::Zero());
  const Eigen::VectorXd wanted =
      -by_hand.S * by_hand.A.transpose() * C.ldlt().solve(closure_errors(problem, none));
  const Trajectory out = chain.keyframes();
  for (std::size_t i = 0; i < problem.odometry.size(); ++i) {
    const Twist e =
        edge_error(problem.odometry[i], out[i].world_from_body, out[i + 1].world_from_body);
    EXPECT_TRUE((e - wanted.segment<6>(static_cast<Eigen::Index>(6 * i))).norm() < 1e-9) << i;
  }
}

TEST(MotionDriftEvidence, MeanErrorsOfOneModelAreItsConditionalMeanAndOfTwoLieBetween) {
  const Problem problem = test::walk(4, 10, 1e-6);
  const MotionModel model = every_term();
  MotionModel other = model;
  for (std::size_t j = 0; j < other.size(); ++j) other[j].value *= j % 2 == 0 ? 3.0 : 0.2;
  const std::vector<EdgeMotion> moved = motions(problem);
  const LoopedChain chain(problem, belief_of(model, problem, moved));
  const auto expected = [&](const MotionModel& of) -> Eigen::VectorXd {
    const Dense by_hand = dense(of, problem);
    const ChainBelief belief = belief_of(of, problem, moved);
    Eigen::MatrixXd C = by_hand.A * by_hand.S * by_hand.A.transpose();
    for (std::size_t k = 0; k < problem.closures.size(); ++k) {
      const auto at = static_cast<Eigen::Index>(6 * k);
      // Factors on halves apart leave out what ties the halves of a closure.
      Matrix6 apart = belief.closure_covariance[k];
      apart.block<3, 3>(0, 3).setZero();
      apart.block<3, 3>(3, 0).setZero();
      C.block<6, 6>(at, at) += apart;
    }
    const std::vector<Twist> none(moved.size(), Twist::Zero());
    return -by_hand.S * by_hand.A.transpose() * C.ldlt().solve(closure_errors(problem, none));
  };
  const Eigen::VectorXd first = expected(model);
  const Eigen::VectorXd second = expected(other);
  const auto near = [](const std::vector<Twist>& errors, const Eigen::VectorXd& wanted) {
    double off = 0.0;
    for (std::size_t i = 0; i < errors.size(); ++i) {
      off += (errors[i] - wanted.segment<6>(static_cast<Eigen::Index>(6 * i))).norm();
    }
    return off < 1e-9;
  };
  EXPECT_TRUE(near(mean_errors({model}, chain, problem, moved), first));
  EXPECT_TRUE(near(mean_errors({model, other, other}, chain, problem, moved),
                   (first + 2.0 * second) / 3.0));
}

/// One gap of size 2 that one term explains, of median variance 1 and spread 1.5.
struct OneGap {
  MotionPrior prior{
      {{.medians = {{Cause::noise, Half::translation, Growth::edge, 1.0}}, .hangs = {{{1, 1.5}}}}},
      2};
  Evidence evidence{{0}, Eigen::VectorXd::Constant(1, 2.0), {Eigen::MatrixXd::Ones(1, 1)}};
};

TEST(MotionDriftPosterior, DrawsFromThePosteriorOfAVarianceThatIntegrationGives) {
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

TEST(MotionDriftPosterior, ASpreadOfZeroKeepsTheMedianAndNoDensityIsAnError) {
  OneGap one;
  one.prior.hypotheses[0].hangs[0][0].spread = 0.0;
  const MotionPosterior drawn = posterior_of(one.prior, one.evidence, {.draws = 5});
  for (const MotionModel& model : drawn.draws) EXPECT_DOUBLE_EQ(model[0].value, 1.0);
  one.prior.hypotheses[0].medians[0].value = 0.0;
  EXPECT_THROW(posterior_of(one.prior, one.evidence, {}), std::runtime_error);
}

TEST(MotionDriftPosterior, HypothesesGetTheChancesThatBayesGivesThem) {
  // Variance 1 or 4, before the gap of 2 believed as one to three.
  OneGap two;
  two.prior.hypotheses[0].hangs[0][0].spread = 0.0;
  two.prior.hypotheses.push_back(two.prior.hypotheses[0]);
  two.prior.hypotheses[0].chance = 0.25;
  two.prior.hypotheses[1].chance = 0.75;
  two.prior.hypotheses[1].medians[0].value = 4.0;
  const double first = 0.25 * std::exp(-2.0);
  const double second = 0.75 * std::exp(-0.5) / 2.0;
  const MotionPosterior drawn = posterior_of(two.prior, two.evidence, {.draws = 4000, .steps = 3});
  EXPECT_NEAR(drawn.chances[0], first / (first + second), 0.03);
  EXPECT_NEAR(drawn.chances[0] + drawn.chances[1], 1.0, 1e-9);
  EXPECT_DOUBLE_EQ(drawn.centre[0].value, 4.0);
}

TEST(MotionDriftPrior, AsStatedOneFactorIsOnEverythingAndTheLastHypothesisDeniesNothing) {
  const Problem problem = test::hand_held();
  const Eigen::VectorXd gap = LoopedChain(problem, stated_belief(problem)).linearised().gap;
  const MotionModel terms{{Cause::noise, Half::rotation, Growth::time},
                          {Cause::stated, Half::rotation, Growth::edge},
                          {Cause::drift, Half::rotation, Growth::time, 0.0, false, 2},
                          {Cause::closures, Half::translation, Growth::edge, 1.0}};
  const MotionPrior prior = prior_of(terms, {}, problem, motions(problem), gap);
  ASSERT_EQ(prior.hypotheses.size(), 6u);
  double chances = 0.0;
  for (const MotionPrior::Hypothesis& one : prior.hypotheses) chances += one.chance;
  EXPECT_NEAR(chances, 1.0, 1e-12);
  for (const Term& term : prior.hypotheses.back().medians) EXPECT_GT(term.value, 0.0);

  Eigen::VectorXd u = Eigen::VectorXd::LinSpaced(prior.unknowns, -1.0, 1.0);
  u[0] = -5.0;  // the first: as stated, nothing drifts
  ASSERT_EQ(hypothesis_at(prior, u), 0u);
  const MotionModel model = model_at(prior, u);
  EXPECT_EQ(model[0].value, 0.0);
  EXPECT_GT(model[1].value, 0.0);
  EXPECT_EQ(model[2].value, 0.0);
  EXPECT_DOUBLE_EQ(model[3].value, model[1].value);
  u[0] = 5.0;
  EXPECT_EQ(hypothesis_at(prior, u), 5u);
}

TEST(MotionDriftPrior, PartsOfTheNoiseAndItsTimeToDriftAreAsTheOptionsSay) {
  const Problem problem = test::planar();
  const std::vector<EdgeMotion> moved = motions(problem);
  const Eigen::VectorXd gap = LoopedChain(problem, stated_belief(problem)).linearised().gap;
  const MotionModel terms{{Cause::noise, Half::rotation, Growth::time},
                          {Cause::drift, Half::rotation, Growth::time, 0.0, false, 2}};
  double seconds = 0.0;  // of a loop, mean, and its square's
  double squared = 0.0;
  for (const Edge& loop : problem.closures) {
    const double long_for = problem.keyframes[loop.to].stamp - problem.keyframes[loop.from].stamp;
    seconds += long_for / static_cast<double>(problem.closures.size());
    squared += long_for * long_for / static_cast<double>(problem.closures.size());
  }
  const MotionPrior prior = prior_of(terms, {.steady_after = 2.0 * seconds}, problem, moved, gap);
  // Half as much drift as noise, in squared angle at the loops' ends.
  const MotionModel& medians = prior.hypotheses.back().medians;
  EXPECT_NEAR(medians[1].value * squared, 0.5 * medians[0].value * seconds, 1e-12);
}

}  // namespace
}  // namespace loopbench

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <numbers>

#include "methods/correctors/chain.hpp"
#include "methods/correctors/motion_drift/evidence.hpp"
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
    for (Eigen::Index i = 0; i < n / 6; ++i) {
      for (Eigen::Index j = 0; j < n / 6; ++j) {
        if (term.cause == Cause::noise && i != j) continue;
        const double a = grown(term.growth, moved[static_cast<std::size_t>(i)]);
        const double b = grown(term.growth, moved[static_cast<std::size_t>(j)]);
        const double entry = term.value * (term.cause == Cause::noise ? a : a * b);
        const Eigen::Index half = term.half == Half::translation ? 0 : 3;
        for (Eigen::Index axis = half; axis < half + 3; ++axis) {
          out.S(6 * i + axis, 6 * j + axis) += entry;
        }
      }
    }
  }
  return out;
}

std::vector<VarianceComponent> components(const MotionModel& model, const Evidence& evidence) {
  std::vector<VarianceComponent> out;
  for (std::size_t j = 0; j < model.size(); ++j) {
    out.push_back({evidence.shares[j], model[j].value, model[j].value});
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
  EXPECT_NEAR(log_evidence(components(model, evidence), evidence.gap), wanted, 1e-5);
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

TEST(Variances, FitNeverGoesDownAndFindsWhereTheDensityIsFlat) {
  const Problem problem = test::walk(7, 16, 0.05);
  const LoopedChain chain(problem, stated_belief(problem));
  const MotionModel model = every_term();
  const Evidence evidence = evidence_of(model, chain, problem, motions(problem), {0, 1, 2});
  std::vector<VarianceComponent> parts = components(model, evidence);
  for (VarianceComponent& c : parts) {
    c.spread = 0.7;
    c.group = 0;
  }
  std::vector<VarianceGroup> groups{{0.0, 2.0}};
  const auto density = [&](const std::vector<VarianceComponent>& at) {
    return log_evidence(at, evidence.gap) + log_prior(at, groups);
  };
  double last = density(parts);
  for (int i = 0; i < 20; ++i) {
    fit(parts, groups, evidence.gap, 1);
    const double now = density(parts);
    EXPECT_GE(now, last - 1e-9);
    last = now;
  }
  fit(parts, groups, evidence.gap, 2000);
  for (std::size_t j = 0; j < parts.size(); ++j) {
    std::vector<VarianceComponent> up = parts;
    std::vector<VarianceComponent> down = parts;
    up[j].value *= std::exp(1e-4);
    down[j].value *= std::exp(-1e-4);
    EXPECT_NEAR((density(up) - density(down)) / 2e-4, 0.0, 1e-4) << j;
  }
}

TEST(Variances, TwoSamplesOfKnownSizesGiveTheirMeanSquares) {
  // A gap of 2 and 4 due to one cause, 1 due to another: variances 10 and 1 by maximum likelihood.
  Eigen::MatrixXd first = Eigen::Vector3d(1, 1, 0).asDiagonal();
  Eigen::MatrixXd second = Eigen::Vector3d(0, 0, 1).asDiagonal();
  std::vector<VarianceComponent> parts{{first, 1.0, 1.0, 1e6}, {second, 5.0, 5.0, 1e6}};
  std::vector<VarianceGroup> groups;
  const Eigen::VectorXd gap = Eigen::Vector3d(2, 4, 1);
  fit(parts, groups, gap, 200);
  EXPECT_NEAR(parts[0].value, 10.0, 1e-6);
  EXPECT_NEAR(parts[1].value, 1.0, 1e-6);
  EXPECT_NEAR(log_evidence(parts, gap),
              -0.5 * (3.0 + 2.0 * std::log(10.0) + 3.0 * std::log(2.0 * std::numbers::pi)),
              1e-9);
}

}  // namespace
}  // namespace loopbench

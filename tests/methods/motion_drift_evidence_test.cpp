#include <gtest/gtest.h>

#include <Eigen/LU>
#include <numbers>

#include "methods/correctors/chain.hpp"
#include "methods/correctors/motion_drift/evidence.hpp"
#include "methods/correctors/motion_drift/posterior.hpp"
#include "tests/support/problems.hpp"
#include "tests/support/random_chain.hpp"

namespace loopbench::motion_drift_evidence_test {

using namespace methods;

namespace {

MotionModel every_term() {
  MotionModel out;
  double value = 0.01;
  for (const Component component : {Component::translation, Component::rotation}) {
    for (const Regressor regressor : kRegressors) {
      out.push_back({TermKind::noise, component, regressor, value});
      out.push_back({TermKind::drift, component, regressor, value *= 0.9});
    }
    out.push_back({TermKind::closures, component, Regressor::edge, 1.5});
  }
  out.push_back({TermKind::drift, Component::rotation, Regressor::time, 0.003, false, 1});
  out.push_back({TermKind::stated, Component::rotation, Regressor::edge, 0.4});
  return out;
}

/// Errors of all closures for the given errors of the edges.
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
  Eigen::MatrixXd A;  ///< Jacobian of all closures by all edges, by finite differences
  Eigen::MatrixXd S;  ///< prior covariance of all edge errors, including drift
};

Dense dense(const MotionModel& model, const Problem& problem) {
  const std::vector<EdgeMotion> edge_motions = motions(problem);
  const auto n = static_cast<Eigen::Index>(6 * edge_motions.size());
  Dense out{Eigen::MatrixXd(6 * static_cast<Eigen::Index>(problem.closures.size()), n),
            Eigen::MatrixXd::Zero(n, n)};
  for (Eigen::Index column = 0; column < n; ++column) {
    const auto perturbed_by = [&](double by) {
      std::vector<Twist> errors(edge_motions.size(), Twist::Zero());
      errors[static_cast<std::size_t>(column / 6)][column % 6] = by;
      return closure_errors(problem, errors);
    };
    out.A.col(column) = (perturbed_by(1e-6) - perturbed_by(-1e-6)) / 2e-6;
  }
  for (const Term& term : model) {
    if (term.kind == TermKind::closures) continue;
    if (term.kind == TermKind::stated) {
      for (Eigen::Index i = 0; i < n / 6; ++i) {
        out.S.block<6, 6>(6 * i, 6 * i) +=
            term.value * problem.odometry[static_cast<std::size_t>(i)].information.inverse();
      }
      continue;
    }
    for (Eigen::Index i = 0; i < n / 6; ++i) {
      for (Eigen::Index j = 0; j < n / 6; ++j) {
        if (term.kind == TermKind::noise && i != j) continue;
        const double a = regressor_value(term.regressor, edge_motions[static_cast<std::size_t>(i)]);
        const double b = regressor_value(term.regressor, edge_motions[static_cast<std::size_t>(j)]);
        const double entry = term.value * (term.kind == TermKind::noise ? a : a * b);
        const Eigen::Index component = term.component == Component::translation ? 0 : 3;
        for (Eigen::Index axis = component; axis < component + 3; ++axis) {
          if (term.axis >= 0 && axis != component + term.axis) continue;
          out.S(6 * i + axis, 6 * j + axis) += entry;
        }
      }
    }
  }
  return out;
}

/// Covariance of the gaps, given that of the closures.
Eigen::MatrixXd gap_covariance(const Dense& by_hand, const std::vector<Matrix6>& closures) {
  Eigen::MatrixXd out = by_hand.A * by_hand.S * by_hand.A.transpose();
  for (std::size_t k = 0; k < closures.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(6 * k);
    out.block<6, 6>(at, at) += closures[k];
  }
  return out;
}

/// Expected errors of the edges given the gaps: e = -S A' (A S A' + S_L)^-1 c.
Eigen::VectorXd conditional_mean(const MotionModel& model,
                                 const Problem& problem,
                                 const std::vector<Matrix6>& closures) {
  const Dense by_hand = dense(model, problem);
  const std::vector<Twist> none(problem.odometry.size(), Twist::Zero());
  return -by_hand.S * by_hand.A.transpose() *
         gap_covariance(by_hand, closures).ldlt().solve(closure_errors(problem, none));
}

TEST(MotionDriftEvidence, EqualsTheDenseGapDensity) {
  Problem problem = test::walk(2, 12, 0.05);
  for (Edge& loop :
       problem.closures) {  // no translation-rotation correlation, so factors are exact
    loop.information.block<3, 3>(0, 3).setZero();
    loop.information.block<3, 3>(3, 0).setZero();
  }
  const MotionModel model = every_term();
  const LoopedChain chain(problem, stated_noise_model(problem));
  const Evidence evidence = evidence_of(model, chain, problem, motions(problem), {0, 1, 2});

  std::vector<Matrix6> closures;
  for (const Edge& loop : problem.closures) closures.push_back(1.5 * loop.information.inverse());
  const Eigen::MatrixXd C = gap_covariance(dense(model, problem), closures);
  const Eigen::VectorXd gap =
      closure_errors(problem, std::vector<Twist>(problem.odometry.size(), Twist::Zero()));
  EXPECT_TRUE(evidence.gap.isApprox(gap, 1e-9));
  const double expected_value =
      -0.5 * (gap.dot(C.inverse() * gap) + std::log(C.determinant()) +
              static_cast<double>(gap.size()) * std::log(2.0 * std::numbers::pi));
  EXPECT_NEAR(log_evidence(model, evidence), expected_value, 1e-5);
}

TEST(MotionDriftEvidence, UsesPlanarRowsAndSelectedClosuresOnly) {
  const Problem problem = test::planar();
  const LoopedChain chain(problem, stated_noise_model(problem));
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
  // Errors are small enough for the problem to be linear.
  const Problem problem = test::walk(4, 10, 1e-6);
  const MotionModel model = every_term();
  const NoiseModel noise_model = noise_model_of(model, problem, motions(problem));
  LoopedChain chain(problem, noise_model);
  for (int i = 0; i < 10; ++i) chain.step();
  const Eigen::VectorXd expected_value =
      conditional_mean(model, problem, noise_model.closure_covariance);
  const Trajectory out = chain.keyframes();
  for (std::size_t i = 0; i < problem.odometry.size(); ++i) {
    const Twist e =
        edge_error(problem.odometry[i], out[i].world_from_body, out[i + 1].world_from_body);
    EXPECT_TRUE((e - expected_value.segment<6>(static_cast<Eigen::Index>(6 * i))).norm() < 1e-9)
        << i;
  }
}

TEST(MotionDriftEvidence, MeanErrorsAverageTheConditionalMeans) {
  const Problem problem = test::walk(4, 10, 1e-6);
  const MotionModel model = every_term();
  MotionModel other = model;
  for (std::size_t j = 0; j < other.size(); ++j) other[j].value *= j % 2 == 0 ? 3.0 : 0.2;
  const std::vector<EdgeMotion> edge_motions = motions(problem);
  const LoopedChain chain(problem, noise_model_of(model, problem, edge_motions));
  const auto expected = [&](const MotionModel& of) -> Eigen::VectorXd {
    NoiseModel noise_model = noise_model_of(of, problem, edge_motions);
    for (Matrix6& covariance : noise_model.closure_covariance) {
      // Separate factors on translation and rotation drop the correlation of a closure.
      covariance.block<3, 3>(0, 3).setZero();
      covariance.block<3, 3>(3, 0).setZero();
    }
    return conditional_mean(of, problem, noise_model.closure_covariance);
  };
  const Eigen::VectorXd first = expected(model);
  const Eigen::VectorXd second = expected(other);
  const auto near = [](const std::vector<Twist>& errors, const Eigen::VectorXd& expected_value) {
    double deviation_sum = 0.0;
    for (std::size_t i = 0; i < errors.size(); ++i) {
      deviation_sum +=
          (errors[i] - expected_value.segment<6>(static_cast<Eigen::Index>(6 * i))).norm();
    }
    return deviation_sum < 1e-9;
  };
  EXPECT_TRUE(near(mean_errors({model}, chain, problem, edge_motions), first));
  EXPECT_TRUE(near(mean_errors({model, other, other}, chain, problem, edge_motions),
                   (first + 2.0 * second) / 3.0));
}

}  // namespace
}  // namespace loopbench::motion_drift_evidence_test

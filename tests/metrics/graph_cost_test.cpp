#include "metrics/correction/graph_cost.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace loopbench::graph_cost_test {

using namespace metrics;

namespace {

/// Two steps of 1 m and a closure over both; each test adds its own error to the estimate.
struct Evaluated {
  Problem problem;
  Trajectory estimate;

  Evaluated() {
    for (int i = 0; i < 3; ++i) {
      problem.keyframes.push_back({double(i), {Rotation::Identity(), Vector3(i, 0.0, 0.0)}});
    }
    const Pose step{Rotation::Identity(), {1.0, 0.0, 0.0}};
    problem.odometry = {{0, 1, step}, {1, 2, step}};
    problem.closures = {{0, 2, step * step}};
    problem.odometry[1].information *= 4.0;
    problem.closures[0].information *= 100.0;
    estimate = problem.keyframes;
  }
  std::vector<double> cost(GraphError error) const {
    Evaluation evaluation;
    evaluation.context.problem = &problem;
    evaluation.context.estimate = &estimate;
    std::vector<double> out;
    for (const Score& score : graph_cost(evaluation, {error})) {
      out.push_back(score.statistics.rmse);
    }
    return out;
  }
};

TEST(GraphCost, IsTheSumOfSquaresByHand) {
  Evaluated evaluated;
  evaluated.estimate[2].world_from_body.translation.x() += 0.1;
  for (const GraphError error : {GraphError::twist, GraphError::quaternion, GraphError::chordal}) {
    const auto cost = evaluated.cost(error);  // (0.1)^2 times 4 and times 100
    ASSERT_EQ(cost.size(), 3u);
    EXPECT_NEAR(cost[0], 1.04, 1e-12) << to_text(error);
    EXPECT_NEAR(cost[1], 0.04, 1e-12);
    EXPECT_NEAR(cost[2], 1.00, 1e-12);
  }
}

TEST(GraphCost, CountsATurnAsEachConventionDoes) {
  Evaluated evaluated;
  evaluated.problem.odometry.resize(1);
  evaluated.problem.closures.clear();
  evaluated.problem.odometry[0].from_from_to = {};
  evaluated.estimate[1].world_from_body = {exp_so3({0.0, 0.0, 1.0}), Vector3::Zero()};
  EXPECT_NEAR(evaluated.cost(GraphError::twist)[0], 1.0, 1e-12);
  EXPECT_NEAR(evaluated.cost(GraphError::quaternion)[0], std::pow(2.0 * std::sin(0.5), 2), 1e-12);
  // |R - I|^2 = 4 (1 - cos 1), kappa = 3 / (2 * 3).
  EXPECT_NEAR(evaluated.cost(GraphError::chordal)[0], 2.0 * (1.0 - std::cos(1.0)), 1e-12);
  evaluated.problem.planar = true;
  EXPECT_NEAR(evaluated.cost(GraphError::quaternion)[0], 1.0, 1e-12);
  EXPECT_NEAR(evaluated.cost(GraphError::chordal)[0], 4.0 * (1.0 - std::cos(1.0)), 1e-12);
}

// 2 m away, with a variance of 4 m^2.
TEST(GraphCost, CountsAnchors) {
  Evaluated evaluated;
  const double edges = evaluated.cost(GraphError::twist)[0];
  const Vector3& at = evaluated.estimate[1].world_from_body.translation;
  evaluated.problem.anchors = {{1, at + Vector3(2.0, 0.0, 0.0), 4.0 * Matrix3::Identity()}};
  const std::vector<double> cost = evaluated.cost(GraphError::twist);
  EXPECT_NEAR(cost[0], edges + 1.0, 1e-12);
  ASSERT_EQ(cost.size(), 4u);
  EXPECT_NEAR(cost[3], 1.0, 1e-12);
}

TEST(GraphCost, NeedsEdgesOfOneUnit) {
  Evaluated evaluated;
  evaluated.problem.closures[0].scale = 2.0;
  EXPECT_THROW(evaluated.cost(GraphError::twist), Undefined);
  EXPECT_THROW(graph_cost({}, {}), std::runtime_error);
}

}  // namespace
}  // namespace loopbench::graph_cost_test

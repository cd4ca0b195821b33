/// Cost of a pose graph, and certificates of its optimality.
#include "metrics/correction/graph_cost.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "metrics/correction/optimality.hpp"

namespace loopbench::graph_cost_test {

using namespace metrics;

namespace {

Evaluation of(const Problem& problem, const Trajectory& estimate) {
  Evaluation out;
  out.context.problem = &problem;
  out.context.estimate = &estimate;
  return out;
}

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
    std::vector<double> out;
    for (const Score& score : graph_cost(of(problem, estimate), {error})) {
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

/// Edges between consecutive keyframes of a ring, without translation. Poses are not set.
Problem ring(const std::vector<Vector3>& rotations) {
  Problem out;
  const std::size_t n = rotations.size();
  out.keyframes.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    out.keyframes[i].stamp = static_cast<double>(i);
    const Pose measured{exp_so3(rotations[i]), Vector3::Zero()};
    if (i + 1 < n) out.odometry.push_back({i, i + 1, measured});
    if (i + 1 == n) out.closures.push_back({0, i, measured.inverse()});
  }
  return out;
}

/// Keyframe i rotated by i / n of `windings` complete turns about z.
Trajectory wound(const Problem& problem, int windings) {
  Trajectory out = problem.keyframes;
  const double step = 2.0 * M_PI * windings / static_cast<double>(out.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i].world_from_body.rotation = exp_so3({0.0, 0.0, step * static_cast<double>(i)});
  }
  return out;
}

TEST(Optimality, EqualsTheOptimumOfATriangleByHand) {
  // Three equal edges share a gap of 1.2 rad: |R - I|^2 = 4 (1 - cos 0.4) each. kappa is the yaw
  // information in the plane and half of the rotation information in space.
  for (const bool planar : {true, false}) {
    Problem problem = ring({{0, 0, 0}, {0, 0, 0}, {0, 0, 1.2}});
    problem.planar = planar;
    const Certificate proof = certificate(problem, wound(problem, 0));
    const double kappa = planar ? 1.0 : 0.5;
    EXPECT_NEAR(proof.cost, 4.0 * kappa * (1.0 - std::cos(1.2)), 1e-12);
    EXPECT_NEAR(proof.minimum, 12.0 * kappa * (1.0 - std::cos(0.4)), 1e-12);
    EXPECT_LE(proof.lower_bound, proof.minimum);
    EXPECT_GT(proof.lower_bound, proof.minimum * (1.0 - 2e-7));
    EXPECT_NEAR(proof.rotation, 0.8, 1e-9);  // keyframe 2, two edges from keyframe 0
  }
}

TEST(Optimality, DistributesTranslationsByHand) {
  // Two steps of 1 m, the sum measured as 2.3 m: 0.1 m per edge, three edges of tau 1.
  Problem problem;
  problem.keyframes.resize(3);
  const auto at = [](double x) { return Pose{Rotation::Identity(), {x, 0.0, 0.0}}; };
  for (std::size_t i = 0; i < 3; ++i) problem.keyframes[i].world_from_body = at(double(i));
  problem.odometry = {{0, 1, at(1.0)}, {1, 2, at(1.0)}};
  problem.closures = {{0, 2, at(2.3)}};
  const Certificate proof = certificate(problem, problem.keyframes);
  EXPECT_NEAR(proof.cost, 0.09, 1e-12);
  EXPECT_NEAR(proof.minimum, 0.03, 1e-12);
  EXPECT_NEAR(proof.lower_bound, 0.03, 5e-8);
}

TEST(Optimality, ConsistentEdgesAreOptimal) {
  const Problem problem = ring({{0, 0, 0.1}, {0, 0, 0.2}, {0, 0, -0.3}});
  Trajectory poses = problem.keyframes;
  poses[1].world_from_body.rotation = exp_so3({0, 0, 0.1});
  poses[2].world_from_body.rotation = exp_so3({0, 0, 0.3});
  for (const Score& score : optimality(of(problem, poses), {})) {
    EXPECT_NEAR(score.statistics.rmse, 0.0, 1e-6) << score.relation << " " << score.axis;
  }
}

/// Rings that are wound once too often keep their winding, a local minimum, if an edge takes less
/// than a right angle.
struct Planted {
  int minima = 0;  ///< starts that stayed at their winding
  int proofs = 0;  ///< minima whose gap is below 1e-4 %
};

Planted planted(int rings, bool planar) {
  Planted out;
  std::mt19937_64 random(planar ? 1 : 2);
  std::normal_distribution<double> noise(0.0, 0.05);
  for (int k = 0; k < rings; ++k) {
    std::vector<Vector3> rotations(5 + static_cast<std::size_t>(k) % 4, Vector3::Zero());
    for (Vector3& rotation : rotations) {
      rotation.z() = noise(random);
      if (!planar) rotation.x() = noise(random), rotation.y() = noise(random);
    }
    Problem problem = ring(rotations);
    problem.planar = planar;
    const Trajectory unwound = wound(problem, 0);
    const Certificate proof = certificate(problem, wound(problem, k % 2 == 0 ? 1 : -1));
    const double possible = certificate(problem, unwound).cost;
    // No bound is above the cost of any poses.
    EXPECT_LE(proof.lower_bound, possible) << k;
    if (proof.minimum > 2.0 * possible) ++out.minima;
    if (proof.minimum > 2.0 * possible && proof.lower_bound > (1.0 - 1e-6) * proof.minimum) {
      ++out.proofs;
    }
  }
  return out;
}

TEST(Optimality, ProvesNoPlantedMinimumOfThePlane) {
  const Planted out = planted(10000, true);
  EXPECT_EQ(out.proofs, 0);
  EXPECT_GT(out.minima, 9900);
}

TEST(Optimality, ProvesNoPlantedMinimumOfSpace) {
  // In space a full turn can be undone, so most starts leave it.
  EXPECT_EQ(planted(500, false).proofs, 0);
}

TEST(Optimality, GapIsThatOfTheEstimateIfTheMinimumIsAnother) {
  // Wound once, five edges of 72 degrees; the minimum without winding costs nothing.
  Problem problem = ring(std::vector<Vector3>(5, Vector3::Zero()));
  problem.planar = true;
  const Trajectory poses = wound(problem, 1);
  EXPECT_NEAR(optimality(of(problem, poses), {})[0].statistics.rmse, 100.0, 1e-9);
}

TEST(Optimality, GapHasWords) {
  EXPECT_EQ(gap_text(9.9e-5), "globally optimal");
  EXPECT_EQ(gap_text(0.0262), "at most 0.0262");
  EXPECT_EQ(gap_text(100.0), "not proved");
}

TEST(Optimality, IsUndefinedWithoutEdgesOrWithScale) {
  EXPECT_THROW(optimality({}, {}), Undefined);
  Problem problem = ring({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}});
  problem.closures[0].scale = 2.0;
  EXPECT_THROW(optimality(of(problem, problem.keyframes), {}), Undefined);
  problem.closures[0].scale = 1.0;
  problem.closures[0].information(0, 0) = std::numeric_limits<double>::infinity();
  EXPECT_THROW(optimality(of(problem, problem.keyframes), {}), std::runtime_error);
  EXPECT_THROW(certificate(problem, {}), std::runtime_error);
}

}  // namespace
}  // namespace loopbench::graph_cost_test

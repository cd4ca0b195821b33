#include <gtest/gtest.h>

#include "datasets/derive/graph_parts.hpp"
#include "datasets/derive/odometry.hpp"
#include "datasets/formats/g2o.hpp"
#include "tests/datasets/random_poses.hpp"
#include "tests/support/tolerance.hpp"

namespace loopbench::compose_edges_test {
namespace {

Matrix6 random_information(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  Matrix6 root;
  for (double& x : root.reshaped()) x = normal(random);
  return 1e3 * (root * root.transpose() + Matrix6::Identity());
}

std::vector<Edge> random_chain(std::size_t size, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<Edge> chain = odometry_edges(random_walk(size, seed, 2.0, 0.5), {});
  for (Edge& edge : chain) edge.information = random_information(random);
  return chain;
}

std::vector<Pose> chained(const std::vector<Edge>& edges) {
  PoseGraph graph;
  graph.edges = edges;
  for (std::size_t i = 0; i <= edges.size(); ++i) {
    graph.ids.push_back(static_cast<std::int64_t>(i));
    if (i < edges.size()) graph.edges[i].from = i;
    if (i < edges.size()) graph.edges[i].to = i + 1;
  }
  return chain(graph);
}

Edge composed(const Edge& a, const Edge& b) { return bridge({a, b}, {0, 2})[0]; }

TEST(ComposeEdges, JoinKeptPosesAsTheChainDoes) {
  const std::vector<Edge> edges = random_chain(40, 3);
  const std::vector<Pose> poses = chained(edges);
  const std::vector<std::size_t> kept = {0, 1, 7, 20, 39};
  const std::vector<Edge> bridged = bridge(edges, kept);
  ASSERT_EQ(bridged.size(), kept.size() - 1);
  for (std::size_t k = 0; k < bridged.size(); ++k) {
    EXPECT_EQ(bridged[k].from, k);
    EXPECT_EQ(bridged[k].to, k + 1);
    const Pose expected = poses[kept[k]].inverse() * poses[kept[k + 1]];
    EXPECT_POSE_NEAR(bridged[k].from_from_to, expected, 1e-12, 1e-12) << k;
    EXPECT_TRUE(bridged[k].information.isApprox(bridged[k].information.transpose(), 0.0));
  }
  EXPECT_EQ(bridged[0].information, edges[0].information);
}

TEST(ComposeEdges, DoNotCareWhereTheyAreCut) {
  const std::vector<Edge> edges = random_chain(12, 4);
  const Edge at_once = bridge(edges, {0, 11})[0];
  const std::vector<Edge> halves = bridge(edges, {0, 5, 11});
  const Edge in_two = composed(halves[0], halves[1]);
  EXPECT_POSE_NEAR(at_once.from_from_to, in_two.from_from_to, 1e-12, 1e-12);
  EXPECT_TRUE(at_once.information.isApprox(in_two.information, 1e-9));
}

TEST(ComposeEdges, AddVariancesOnAStraightLine) {
  // Two steps of 1 m along x: the yaw error of the first one moves the end sideways by its lever
  // arm.
  Edge step{0, 1, {Rotation::Identity(), {1.0, 0.0, 0.0}}, isotropic_information(0.01, 0.04)};
  const Matrix6 covariance = composed(step, step).information.inverse();
  EXPECT_NEAR(covariance(0, 0), 0.02, 1e-12);
  EXPECT_NEAR(covariance(1, 1), 0.02 + 0.04, 1e-12);
  EXPECT_NEAR(covariance(5, 5), 0.08, 1e-12);
  EXPECT_NEAR(covariance(1, 5), 0.04, 1e-12);
  EXPECT_NEAR(covariance(2, 4), -0.04, 1e-12);
}

TEST(ComposeEdges, CovarianceAgreesWithSampling) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  const std::vector<Edge> edges = random_chain(4, 6);
  const Edge complete = bridge(edges, {0, 3})[0];
  const int samples = 40000;
  Matrix6 sampled = Matrix6::Zero();
  for (int s = 0; s < samples; ++s) {
    Pose end;
    for (const Edge& edge : edges) {
      Twist error;
      for (double& e : error) e = normal(random);
      const Matrix6 root = Matrix6(edge.information.inverse()).llt().matrixL();
      end = end * edge.from_from_to * exp_se3(root * error);
    }
    const Twist error = log_se3(complete.from_from_to.inverse() * end);
    sampled += error * error.transpose() / samples;
  }
  const Matrix6 root = Matrix6(complete.information).llt().matrixL();
  const Matrix6 whitened = root.transpose() * sampled * root;
  // Standard error of an entry is 1/sqrt(samples) = 0.005; second-order terms are of that size.
  EXPECT_LT((whitened - Matrix6::Identity()).cwiseAbs().maxCoeff(), 0.04);
}

TEST(ComposeEdges, CarryTheScaleOfASimilarityChain) {
  Edge doubling{0, 1, {Rotation::Identity(), {1.0, 0.0, 0.0}}, Matrix6::Identity(), 2.0};
  const std::vector<Pose> poses = chained({doubling, doubling, doubling});
  EXPECT_DOUBLE_EQ(poses[3].translation.x(), 1.0 + 2.0 + 4.0);
  const Edge complete = bridge({doubling, doubling, doubling}, {0, 3})[0];
  EXPECT_DOUBLE_EQ(complete.from_from_to.translation.x(), 7.0);
  EXPECT_DOUBLE_EQ(complete.scale, 8.0);
}

TEST(ComposeEdges, CarryTheCovarianceOfASimilarityChain) {
  // Scale 2: a length of 0.1 in the scale of the second pose is 0.2 in that of the first.
  Edge exact{0, 1, {Rotation::Identity(), {1.0, 0.0, 0.0}}, isotropic_information(1e-16, 1e-16)};
  exact.scale = 2.0;
  Edge noisy{1, 2, {Rotation::Identity(), {1.0, 0.0, 0.0}}, isotropic_information(0.01, 0.04)};
  Matrix6 covariance = composed(exact, noisy).information.inverse();
  EXPECT_NEAR(std::sqrt(covariance(0, 0)), 0.2, 1e-9);
  EXPECT_NEAR(std::sqrt(covariance(5, 5)), 0.2, 1e-9);
  // The lever arm of the first edge's rotation is the second edge in the scale of the first: 2.
  std::swap(exact.information, noisy.information);
  covariance = composed(exact, noisy).information.inverse();
  EXPECT_NEAR(covariance(1, 1), 0.01 + 0.04 * 4.0, 1e-9);
}

TEST(ComposeEdges, RefuseAnInformationWithoutInverse) {
  Edge blind;
  blind.to = 1;
  blind.information(3, 3) = 0.0;
  EXPECT_THROW(composed(blind, blind), std::invalid_argument);
}

TEST(OdometryEdges, StateTheirModel) {
  const Trajectory poses = on_a_line({0.0, 4.0, 4.0});
  const std::vector<Edge> edges = odometry_edges(poses, {0.3, 0.1, 0.2, 0.05});
  ASSERT_EQ(edges.size(), 2u);
  EXPECT_DOUBLE_EQ(edges[0].from_from_to.translation.x(), 4.0);
  EXPECT_NEAR(1.0 / edges[0].information(0, 0), 0.09 + 0.04 * 4.0, 1e-12);
  EXPECT_NEAR(1.0 / edges[0].information(5, 5), 0.01 + 0.0025 * 4.0, 1e-12);
  EXPECT_NEAR(1.0 / edges[1].information(2, 2), 0.09, 1e-12);
  EXPECT_TRUE(odometry_edges({}, {}).empty());
}

TEST(OdometryEdges, DefaultCovariancesDoNotDependOnHowTheWayIsCut) {
  // 40 m with one full rotation, as 1 or 8 edges: equal variances except for the constant term.
  const auto total = [](std::size_t edges, int axis) {
    Trajectory poses;
    for (std::size_t i = 0; i <= edges; ++i) {
      const double share = static_cast<double>(i) / static_cast<double>(edges);
      poses.push_back({share, {exp_so3({0.0, 0.0, 3.0 * share}), {40.0 * share, 0.0, 0.0}}});
    }
    double sum = 0.0;
    for (const Edge& edge : odometry_edges(poses, {})) sum += 1.0 / edge.information(axis, axis);
    return sum;
  };
  EXPECT_NEAR(total(8, 0), total(1, 0), 1e-3 * total(1, 0));
  EXPECT_NEAR(total(8, 5), total(1, 5), 1e-2 * total(1, 5));
  EXPECT_NEAR(total(1, 0), 0.02 * 0.02 * (40.0 + 3.0), 1e-3 * total(1, 0));
  EXPECT_NEAR(total(1, 5), 5e-4 * 5e-4 * 40.0 + 5e-3 * 5e-3 * 3.0, 1e-3 * total(1, 5));
}

TEST(OdometryEdges, RotationAddsItsShare) {
  Trajectory poses = on_a_line({0.0, 4.0});
  poses[1].world_from_body.rotation = exp_so3({0.0, 0.5, 0.0});
  const EdgeNoise noise{0.3, 0.1, 0.2, 0.05, 0.4, 0.3};
  const Edge edge = odometry_edges(poses, noise)[0];
  EXPECT_NEAR(1.0 / edge.information(0, 0), 0.09 + 0.04 * 4.0 + 0.16 * 0.5, 1e-12);
  EXPECT_NEAR(1.0 / edge.information(5, 5), 0.01 + 0.0025 * 4.0 + 0.09 * 0.5, 1e-12);
}

}  // namespace
}  // namespace loopbench::compose_edges_test

#include "datasets/formats/g2o.hpp"

#include <gtest/gtest.h>

#include <random>

#include "datasets/formats/formats.hpp"
#include "tests/datasets/scratch.hpp"
#include "tests/support/tolerance.hpp"

namespace loopbench::g2o_test {
namespace {

constexpr double kQuarter = 0.5 * M_PI;

Pose planar(double x, double y, double yaw) { return {exp_so3({0, 0, yaw}), {x, y, 0}}; }

/// A chain with two loops and dense, well-conditioned information.
PoseGraph random_graph(bool is_planar, bool is_similarity) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  PoseGraph out;
  out.planar = is_planar;
  out.similarity = is_similarity;
  const auto pose = [&] {
    if (is_planar) return planar(normal(random), normal(random), normal(random));
    const Rotation q(normal(random), normal(random), normal(random), normal(random));
    return Pose{q.normalized(), {normal(random), normal(random), normal(random)}};
  };
  const auto edge = [&](std::size_t from, std::size_t to) {
    Edge e{from, to, pose()};
    Matrix6 root = Matrix6::NullaryExpr([&] { return normal(random); });
    e.information = root * root.transpose() + Matrix6::Identity();
    if (is_similarity) e.scale = 1.0 + 0.1 * static_cast<double>(to);
    out.edges.push_back(e);
  };
  for (std::size_t i = 0; i < 20; ++i) {
    out.ids.push_back(static_cast<std::int64_t>(3 * i));
    out.vertices.push_back(pose());
    if (i > 0) edge(i - 1, i);
  }
  edge(0, 19);
  edge(4, 11);
  return out;
}

void expect_same(const PoseGraph& a, const PoseGraph& b, double tolerance) {
  EXPECT_EQ(a.ids, b.ids);
  EXPECT_EQ(a.planar, b.planar);
  EXPECT_EQ(a.similarity, b.similarity);
  ASSERT_EQ(a.vertices.size(), b.vertices.size());
  for (std::size_t i = 0; i < a.vertices.size(); ++i) {
    EXPECT_TRUE(is_close(a.vertices[i], b.vertices[i], 0.0, tolerance)) << i;
  }
  ASSERT_EQ(a.edges.size(), b.edges.size());
  for (std::size_t i = 0; i < a.edges.size(); ++i) {
    EXPECT_EQ(a.edges[i].from, b.edges[i].from);
    EXPECT_EQ(a.edges[i].to, b.edges[i].to);
    EXPECT_TRUE(is_close(a.edges[i].from_from_to, b.edges[i].from_from_to, 0.0, tolerance)) << i;
    EXPECT_NEAR(a.edges[i].scale, b.edges[i].scale, tolerance);
  }
}

TEST(G2o, ReadsVerticesInOrderOfIds) {
  const PoseGraph graph = read_g2o(sample("good/se2.g2o"));
  EXPECT_TRUE(graph.planar);
  EXPECT_FALSE(graph.similarity);
  EXPECT_EQ(graph.ids, (std::vector<std::int64_t>{10, 20, 30}));
  EXPECT_POSE_NEAR(graph.vertices[1], planar(1, 0, kQuarter), 5e-15, 5e-15);
  EXPECT_EQ(graph.lines, (std::vector<std::size_t>{7, 8, 9}));
}

TEST(G2o, PlanarInformationStandsAtXYAndYaw) {
  const Matrix6 information = read_g2o(sample("good/se2.g2o")).edges[0].information;
  Matrix6 expected = Matrix6::Zero();
  expected.diagonal() << 4, 5, 4.5, 6, 6, 6;
  expected(0, 1) = expected(1, 0) = 1;
  EXPECT_EQ(information, expected);
}

TEST(G2o, EdgesWrittenBackwardsAreInverted) {
  const PoseGraph graph = read_g2o(sample("good/se2.g2o"));
  const Edge& loop = graph.edges[2];
  EXPECT_EQ(loop.from, 0u);
  EXPECT_EQ(loop.to, 2u);
  // Vertex 10 in the frame of 30 is (1, 1) with a rotation of pi, so 30 in the frame of 10 is (1,
  // 1).
  EXPECT_POSE_NEAR(loop.from_from_to, planar(1, 1, M_PI), 5e-15, 5e-15);
}

TEST(G2o, InversionKeepsTheCostOfEveryError) {
  const TemporaryFolder scratch;
  const PoseGraph forward = random_graph(false, false);
  write_g2o(scratch.path() / "a.g2o", forward);
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  for (const Edge& edge : forward.edges) {
    // With exchanged ids the line contains the pose of `from` in the frame of `to`.
    PoseGraph one;
    one.ids = {0, 1};
    one.edges = {edge};
    one.edges[0].from = 1;
    one.edges[0].to = 0;
    write_g2o(scratch.path() / "one.g2o", one);
    const Edge back = read_g2o(scratch.path() / "one.g2o").edges[0];
    const Twist small = 1e-6 * Twist::NullaryExpr([&] { return normal(random); });
    const Pose perturbed = edge.from_from_to * exp_se3(small);
    const Twist other = log_se3(back.from_from_to.inverse() * perturbed.inverse());
    const double cost = small.dot(edge.information * small);
    EXPECT_NEAR(other.dot(back.information * other), cost, 1e-4 * cost);
  }
}

TEST(G2o, HalfAnglesBecomeAngles) {
  // The file has 4, 8, ..., 24 on the diagonal and 2 between x and q_x.
  const Edge edge = read_g2o(sample("good/se3.g2o")).edges[0];
  Matrix6 expected = Matrix6::Zero();
  expected.diagonal() << 4, 8, 12, 4, 5, 6;
  expected(0, 3) = expected(3, 0) = 1;
  EXPECT_EQ(edge.information, expected);
}

TEST(G2o, CostEqualsG2osOwnErrorForSmallErrors) {
  const Edge edge = read_g2o(sample("good/se3.g2o")).edges[0];
  const Twist small = twist({1e-5, -2e-5, 3e-5}, {2e-5, 1e-5, -3e-5});
  const Pose delta = exp_se3(small);  // Z^-1 Xi^-1 Xj
  Twist g2o;
  g2o << delta.translation, delta.rotation.vec();
  Matrix6 in_file = Matrix6::Zero();
  in_file.diagonal() << 4, 8, 12, 16, 20, 24;
  in_file(0, 3) = in_file(3, 0) = 2;
  const double cost = g2o.dot(in_file * g2o);
  EXPECT_NEAR(small.dot(edge.information * small), cost, 1e-4 * cost);
}

TEST(G2o, SimilarityScaleIsUnitOfFirstOverSecondId) {
  const PoseGraph graph = read_g2o(sample("good/rst3.g2o"));
  EXPECT_TRUE(graph.similarity);
  EXPECT_EQ(graph.edges[0].scale, 1.0);
  const Edge& loop =
      graph.edges[2];  // written as 2 -> 0 with scale 4: scale of 2 is 4 times that of 0
  EXPECT_EQ(loop.from, 0u);
  EXPECT_EQ(loop.to, 2u);
  EXPECT_EQ(loop.scale, 4.0);
  EXPECT_POSE_NEAR(loop.from_from_to, planar(2, 0, 0), 1e-15, 1e-15);
}

TEST(G2o, SimilarityInformationMayHoldTheScaleToo) {
  const TemporaryFolder scratch;
  std::string line = "EDGE_RST3:QUAT 0 1 1 0 0 0 0 0 1 2";
  for (int i = 0; i < 7; ++i) {
    for (int j = i; j < 7; ++j) line += i == j ? " 4" : " 0";
  }
  const Edge edge = read_g2o(scratch.file("a.g2o", line + "\n")).edges[0];
  Matrix6 expected = Matrix6::Identity();
  expected.topLeftCorner<3, 3>() *= 4.0;
  EXPECT_EQ(edge.information, expected);
  EXPECT_EQ(edge.scale, 0.5);
  EXPECT_EQ(edge.scale_information, 4.0);
}

TEST(G2o, WritesTheInformationOfTheScale) {
  const TemporaryFolder scratch;
  PoseGraph graph = random_graph(false, false);
  graph.similarity = true;
  graph.edges[0].scale_information = 7.0;
  graph.edges[1].scale = 2.0;
  write_g2o(scratch.path() / "a.g2o", graph);
  const PoseGraph back = read_g2o(scratch.path() / "a.g2o");
  ASSERT_EQ(back.edges.size(), graph.edges.size());
  EXPECT_EQ(back.edges[0].scale_information, 7.0);
  EXPECT_EQ(back.edges[1].scale_information, 0.0);
  EXPECT_TRUE(back.edges[0].information.isApprox(graph.edges[0].information, 1e-15));
}

TEST(G2o, ToroAnglesAreRollPitchYawAboutFixedAxes) {
  const PoseGraph graph = read_g2o(sample("good/toro.txt"));
  EXPECT_FALSE(graph.planar);
  EXPECT_TRUE(graph.vertices.empty());
  EXPECT_EQ(graph.ids.size(), 3u);
  const Eigen::Quaterniond q = Eigen::AngleAxisd(0.3, Vector3::UnitZ()) *
                               Eigen::AngleAxisd(0.2, Vector3::UnitY()) *
                               Eigen::AngleAxisd(0.1, Vector3::UnitX());
  EXPECT_NEAR(angle_between(graph.edges[0].from_from_to.rotation, Rotation(q)), 0.0, 1e-15);
  Twist diagonal;
  diagonal << 10, 10, 10, 100, 81, 25;
  EXPECT_EQ(graph.edges[0].information.diagonal(), diagonal);
}

TEST(G2o, WritingAndReadingKeepsTheGraph) {
  const TemporaryFolder scratch;
  const auto file = scratch.path() / "a.g2o";
  const PoseGraph spatial = random_graph(false, false);
  write_g2o(file, spatial);
  const PoseGraph back = read_g2o(file);
  expect_same(back, spatial, 0.0);
  for (std::size_t i = 0; i < back.edges.size(); ++i) {
    EXPECT_EQ(back.edges[i].information,
              spatial.edges[i].information.selfadjointView<Eigen::Upper>().toDenseMatrix());
  }
  const PoseGraph similarity = random_graph(false, true);
  write_g2o(file, similarity);
  expect_same(read_g2o(file), similarity, 5e-15);
  const PoseGraph flat = random_graph(true, false);
  write_g2o(file, flat);
  expect_same(read_g2o(file), flat, 5e-15);
}

TEST(Chain, PutsConsecutiveEdgesBehindEachOther) {
  const PoseGraph graph = read_g2o(sample("good/se2_edges.g2o"));
  const std::vector<Pose> poses = chain(graph);
  ASSERT_EQ(poses.size(), 3u);
  EXPECT_TRUE(is_close(poses[0], {}, 0.0, 0.0));
  EXPECT_POSE_NEAR(poses[1], planar(1, 0, kQuarter), 1e-15, 1e-15);
  EXPECT_POSE_NEAR(poses[2], planar(1, 1, 2 * kQuarter), 5e-15, 5e-15);
}

TEST(Chain, CarriesScaleAlong) {
  const TemporaryFolder scratch;
  PoseGraph graph;
  graph.ids = {0, 1, 2};
  graph.similarity = true;
  graph.edges = {{0, 1, planar(1, 0, 0), Matrix6::Identity(), 2.0},
                 {1, 2, planar(1, 0, 0), Matrix6::Identity(), 1.0}};
  EXPECT_EQ(chain(graph)[2].translation, Vector3(3, 0, 0));
}

TEST(Chain, FollowsTheFewestEdgesIfAStepIsMissing) {
  PoseGraph graph;
  graph.ids = {0, 1, 2, 3};
  graph.similarity = true;
  graph.edges = {{0, 2, planar(1, 0, kQuarter), Matrix6::Identity(), 2.0},
                 {2, 3, planar(1, 0, 0)},
                 {1, 3, planar(0, 5, 0)}};  // against its direction
  const std::vector<Pose> poses = chain(graph);
  EXPECT_POSE_NEAR(poses[2], planar(1, 0, kQuarter), 1e-15, 1e-15);
  EXPECT_POSE_NEAR(poses[3], planar(1, 2, kQuarter), 1e-15, 1e-15);
  EXPECT_POSE_NEAR(poses[1], planar(11, 2, kQuarter), 1e-14, 1e-15);
}

TEST(G2o, GivesATrajectoryOfVerticesOrOfTheChain) {
  ReadOptions options;
  options.period = 0.5;
  const Trajectory vertices = read_trajectory(sample("good/se2.g2o"), options);
  EXPECT_EQ(stamps(vertices), (std::vector{5.0, 10.0, 15.0}));
  const Trajectory chained = read_trajectory(sample("good/se2_edges.g2o"), options);
  EXPECT_EQ(stamps(chained), (std::vector{0.0, 0.5, 1.0}));
  EXPECT_TRUE(chained[2].world_from_body.translation.isApprox(Vector3(1, 1, 0)));
}

TEST(G2o, TrajectoriesNeedNoDefiniteInformation) {
  const TemporaryFolder scratch;
  const auto file = scratch.file(
      "rounded.g2o",
      "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\nEDGE_SE2 0 1 1 0 0 1 1 0 0.999999 0 1\n");
  EXPECT_EQ(read_trajectory(file).size(), 2u);
  EXPECT_NE(refusal([&] { read_g2o(file); }).find(":3: information is not"), std::string::npos);
}

TEST(G2o, StampsOfSymbolsAreTheirIndices) {
  PoseGraph graph;
  const auto symbol = [](char letter, std::int64_t index) {
    return (std::int64_t{letter} << 56) + index;
  };
  graph.ids = {symbol('a', 0), symbol('a', 1), symbol('a', 4)};
  EXPECT_EQ(vertex_stamps(graph, 0.5), (std::vector<double>{0.0, 0.5, 2.0}));
  graph.ids.push_back(symbol('b', 0));  // a second robot: the order of the file
  EXPECT_EQ(vertex_stamps(graph, 0.5), (std::vector<double>{0.0, 0.5, 1.0, 1.5}));
  graph.ids = {3, 4, symbol('a', 5)};  // numbers and symbols
  EXPECT_EQ(vertex_stamps(graph, 0.5), (std::vector<double>{1.5, 2.0, 2.5}));
  graph.ids = {-3, 4, symbol('a', 4)};
  EXPECT_EQ(vertex_stamps(graph, 0.5), (std::vector<double>{0.0, 0.5, 1.0}));
  graph.ids = {2, 7};
  EXPECT_EQ(vertex_stamps(graph, 0.5), (std::vector<double>{1.0, 3.5}));
}

TEST(G2o, RefusesWhatOverflowsOnTheWay) {
  const TemporaryFolder scratch;
  const auto error_of = [&](const std::string& text) {
    const auto file = scratch.file("a.g2o", text);
    const std::string message = refusal([&] { read_trajectory(file); });
    EXPECT_TRUE(message.starts_with(file.string())) << message;
    return message.substr(file.string().size());
  };
  EXPECT_EQ(error_of("EDGE_SE2 30 0 1 1 -3 141592653589793267948964 0 0 5 0 6\n"),
            ":1: information is not positive definite after inversion of the edge");
  EXPECT_EQ(error_of("EDGE_SE2 0 1 1e308 0 0 1 0 0 1 0 1\nEDGE_SE2 1 2 1e308 0 0 1 0 0 1 0 1\n"),
            ": pose 2: is not finite");
  EXPECT_EQ(error_of("VERTEX_RST3:QUAT 0 0 0 0 0 0 0 1 1e-310\n"),
            ":1: scale is 1e-310, too small to be inverted");
}

}  // namespace
}  // namespace loopbench::g2o_test

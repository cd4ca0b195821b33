// Planar lines of TORO: VERTEX2 and EDGE2, whose information has an order of its own.
#include <gtest/gtest.h>

#include "datasets/formats/formats.hpp"
#include "datasets/formats/g2o.hpp"
#include "tests/datasets/scratch.hpp"

namespace loopbench::toro_test {
namespace {

constexpr const char* kVertices = "VERTEX2 0 0 0 0\nVERTEX2 1 1 0.5 1.5707963267948966\n";

PoseGraph with_edge(const std::string& edge, const InformationRules& rules = {}) {
  const TemporaryFolder scratch;
  return read_g2o(scratch.file("toro.graph", kVertices + edge + "\n"), rules);
}

// EDGE2 i j forward sideward rotate ff fs ss rr fr sr (README-fileformat of HOG-Man and TORO).
TEST(Toro, InformationIsReadInItsOrder) {
  const PoseGraph graph = with_edge("EDGE2 0 1 1 0.5 1.5707963267948966 4 1 5 6 0.5 0.25");
  EXPECT_TRUE(graph.planar);
  ASSERT_EQ(graph.edges.size(), 1u);
  const Matrix6& information = graph.edges[0].information;
  EXPECT_EQ(information(0, 0), 4.0);
  EXPECT_EQ(information(0, 1), 1.0);
  EXPECT_EQ(information(1, 1), 5.0);
  EXPECT_EQ(information(5, 5), 6.0);
  EXPECT_EQ(information(0, 5), 0.5);
  EXPECT_EQ(information(1, 5), 0.25);
  const PoseGraph rows = with_edge("EDGE_SE2 0 1 1 0.5 1.5707963267948966 4 1 0.5 5 0.25 6");
  EXPECT_EQ(information, rows.edges[0].information);
  EXPECT_EQ(graph.edges[0].from_from_to.translation, Vector3(1.0, 0.5, 0.0));
}

// Vertex 0 seen from vertex 1, which looks along y: 0.5 m behind it, 1 m to its left.
TEST(Toro, TheFirstIdObservesTheSecond) {
  const PoseGraph graph = with_edge("EDGE2 1 0 -0.5 1 -1.5707963267948966 4 0 4 6 0 0");
  const Edge& edge = graph.edges[0];
  EXPECT_EQ(edge.from, 0u);
  EXPECT_EQ(edge.to, 1u);
  const Pose step = graph.vertices[0].inverse() * graph.vertices[1];
  EXPECT_NEAR((edge.from_from_to.translation - step.translation).norm(), 0.0, 1e-15);
  EXPECT_NEAR(angle_between(edge.from_from_to.rotation, step.rotation), 0.0, 1e-15);
}

TEST(Toro, InformationInRowsIsNamed) {
  const std::string rows = "EDGE2 0 1 1 0 0 4 0 0 5 0 6";
  const std::string why = refusal([&] { with_edge(rows); });
  EXPECT_NE(why.find(":3: information is positive definite row by row"), std::string::npos) << why;
  EXPECT_NE(why.find("expected tag EDGE_SE2"), std::string::npos) << why;
  const std::string neither = refusal([&] { with_edge("EDGE2 0 1 1 0 0 0 0 0 0 0 0"); });
  EXPECT_NE(neither.find(":3: information is not positive definite"), std::string::npos) << neither;
  const InformationRules any{.indefinite = IndefiniteInformation::project};
  EXPECT_EQ(with_edge(rows, any).altered, 1u);
}

TEST(Toro, VerticesAreATrajectory) {
  const TemporaryFolder scratch;
  const auto file = scratch.file("vertices.graph", kVertices);
  EXPECT_EQ(detect_format(file), Format::g2o);
  EXPECT_EQ(read_g2o(file).ids.size(), 2u);
}

}  // namespace
}  // namespace loopbench::toro_test

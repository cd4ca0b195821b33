// Lines of g2o files beside vertices and edges, and lines that are refused.
#include <gtest/gtest.h>

#include "datasets/formats/formats.hpp"
#include "datasets/formats/g2o.hpp"
#include "tests/datasets/scratch.hpp"

namespace loopbench::g2o_records_test {
namespace {

/// Two vertices 3 and 7, with lines before and after.
PoseGraph with_lines(const std::string& before, const std::string& after, bool spatial = true) {
  const TemporaryFolder scratch;
  const std::string vertices =
      spatial ? "VERTEX_SE3:QUAT 3 0 0 0 0 0 0 1\nVERTEX_SE3:QUAT 7 1 0 0 0 0 0 1\n"
              : "VERTEX_SE2 3 0 0 0\nVERTEX_SE2 7 1 0 0\n";
  return read_g2o(scratch.file("lines.g2o", before + vertices + after));
}

TEST(G2oRecords, ReadsFixedVerticesAndParameters) {
  const PoseGraph graph = with_lines("PARAMS_SE3OFFSET 0 0 0 0 0 0 0 1\nFIX 7\n", "FIX 3 7\n");
  EXPECT_EQ(graph.fixed, (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(graph.ids.size(), 2u);
  const std::string why = refusal([] { with_lines("", "FIX 8\n"); });
  EXPECT_NE(why.find(":3: FIX refers to vertex 8, which has no VERTEX line"), std::string::npos);
  const TemporaryFolder scratch;
  write_g2o(scratch.path() / "fixed.g2o", graph);
  EXPECT_EQ(read_g2o(scratch.path() / "fixed.g2o").fixed, graph.fixed);
  EXPECT_EQ(with_lines("FIX 3\nFIX 7\nFIX 7\n", "").fixed, graph.fixed);
  for (const char* parameters : {"PARAMS_CAMERACALIB 0 0 0 0 0 0 0 1 1 1 1 1\n",
                                 "PARAMS_SE2OFFSET 0 0 0 0\n",
                                 "# made by a tool\nPARAMS_CAMERAPARAMETERS 0 1 2 3 4\n"}) {
    EXPECT_EQ(detect_format(scratch.file("first.g2o", parameters)), Format::g2o);
    EXPECT_EQ(with_lines(parameters, parameters).ids.size(), 2u);
  }
}

void expect_prior(const PoseGraph& graph, const Vector3& position, const Matrix3& covariance) {
  ASSERT_EQ(graph.priors.size(), 1u);
  const Anchor& anchor = graph.priors.front();
  EXPECT_EQ(anchor.keyframe, 1u);
  EXPECT_NEAR((anchor.position - position).norm(), 0.0, 1e-15);
  EXPECT_NEAR((anchor.covariance - covariance).norm(), 0.0, 1e-12);
}

// g2o: error = Z^-1 X offset. A line that names no parameter, or an unknown one, measures the
// vertex.
TEST(G2oRecords, PriorsMeasureTheSensorOfTheirParameter) {
  const std::string offset = "PARAMS_SE3OFFSET 4 1 0.5 -2 0 0 0 1\n";
  const std::string pose = " 9 8 7 0 0 0 1 4 0 0 0 0 0 4 0 0 0 0 4 0 0 0 1 0 0 1 0 1\n";
  const auto point = [&](const std::string& prior) {
    return with_lines(offset, "EDGE_SE3_PRIOR 7" + prior + pose).priors.front().point_in_body;
  };
  EXPECT_EQ(point(" 4"), Vector3(1.0, 0.5, -2.0));
  EXPECT_EQ(point(" 5"), Vector3::Zero());
  EXPECT_EQ(point(""), Vector3::Zero());
  const std::string why = refusal([] { with_lines("PARAMS_SE3OFFSET 4 1 0.5\n", "FIX 3\n"); });
  EXPECT_NE(why.find(":1: "), std::string::npos) << why;
}

TEST(G2oRecords, PriorsAreAnchors) {
  const std::string full = "4 0 0 0 0 0 16 0 0 0 0 25 0 0 0 1 0 0 1 0 1\n";
  const std::string gnss = "4 0 0 0 0 0 16 0 0 0 0 25 0 0 0 0 0 0 0 0 0\n";
  // A rotation of 90 deg about z exchanges x and y.
  const std::string pose = " 9 8 7 0 0 0.70710678118654752 0.70710678118654752 ";
  const Matrix3 turned = Vector3(1.0 / 16, 1.0 / 4, 1.0 / 25).asDiagonal();
  expect_prior(with_lines("", "EDGE_SE3_PRIOR 7" + pose + full), {9, 8, 7}, turned);
  expect_prior(with_lines("", "EDGE_SE3_PRIOR 7 0" + pose + gnss), {9, 8, 7}, turned);
  expect_prior(
      with_lines("", "EDGE_POINTXYZ 7 9 8 7 4 0 0 4 0 4\n"), {9, 8, 7}, 0.25 * Matrix3::Identity());
  const auto in_plane = [](const std::string& line) { return with_lines("", line, false); };
  expect_prior(in_plane("EDGE_PRIOR_SE2 7 9 8 1.5707963267948966 4 0 0 16 0 1\n"),
               {9, 8, 0},
               Vector3(1.0 / 16, 1.0 / 4, 1.0 / 4).asDiagonal());
  for (const std::string tag : {"EDGE_PRIOR_SE2_XY", "EDGE_SE2_XYPRIOR"}) {
    const Matrix3 flat = Vector3(0.25, 0.0625, 0.25).asDiagonal();
    expect_prior(in_plane(tag + " 7 9 8 4 0 16\n"), {9, 8, 0}, flat);
  }
  EXPECT_NE(
      refusal([&] { in_plane("EDGE_PRIOR_SE2_XY 7 9 8 4 0\n"); }).find("7: EDGE_PRIOR_SE2_XY"),
      std::string::npos);
  EXPECT_NE(refusal([&] { in_plane("EDGE_PRIOR_SE2_XY 7 9 8 0 0 0\n"); }).find("not positive"),
            std::string::npos);
}

TEST(G2oRecords, DecimalCommasAreNamed) {
  const std::string rest = " 1 0 0 1 0 1\n";
  for (const std::string& line : {"EDGE_SE2 3 7 0,5 0 0" + rest,
                                  "EDGE_SE2 3 7 0,5 0,25 -0,1" + rest,
                                  std::string("VERTEX_SE2 8 0,5 1,0 0,1\n")}) {
    const std::string why = refusal([&] { with_lines("", line, false); });
    EXPECT_NE(why.find("(decimal commas: expected decimal points)"), std::string::npos) << why;
    EXPECT_NE(why.find(":3: has "), std::string::npos) << why;
  }
}

TEST(G2oRecords, VerticesOfOtherRobotsAreNamed) {
  const std::string b0 = std::to_string(std::int64_t{'b'} << 56), rest = " 1 0 0 1 0 0 1 0 1\n";
  for (const std::string& line : {"EDGE_SE2 7 " + b0 + rest,
                                  "EDGE_SE2 " + b0 + " 3" + rest,
                                  "EDGE_PRIOR_SE2_XY " + b0 + " 0 0 1 0 1\n",
                                  "FIX " + b0 + "\n"}) {
    const std::string why = refusal([&] { with_lines("", line, false); });
    EXPECT_NE(why.find(":3: "), std::string::npos) << why;
    EXPECT_NE(why.find("refers to vertex b0, which has no VERTEX line: expected vertices"),
              std::string::npos)
        << why;
  }
}

TEST(G2oRecords, SwitchableEdgesAreRefusedWithWhatReplacesThem) {
  for (const char* line : {"VERTEX_SWITCH 5 1\n",
                           "EDGE_SWITCH_PRIOR 5 1 1\n",
                           "EDGE_SE2_SWITCHABLE 3 7 5 1 0 0 1 0 0 1 0 1\n"}) {
    const std::string why = refusal([&] { with_lines("", line, false); });
    EXPECT_NE(why.find("pose_graph_dcs and pose_graph_gnc_tls"), std::string::npos) << why;
  }
}

}  // namespace
}  // namespace loopbench::g2o_records_test

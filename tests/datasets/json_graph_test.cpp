// Pose graphs in JSON: conventions of Open3D and of JSON Robot Logs.
#include "datasets/formats/json_graph.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "datasets/formats/detect_format.hpp"
#include "datasets/formats/trajectory_file.hpp"
#include "tests/datasets/scratch.hpp"
#include "tests/support/tolerance.hpp"

namespace loopbench::test::json_graph_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string identity_with(const std::string& value, int at) {
  std::string out;
  for (int i = 0; i < 36; ++i) {
    out += (i == 0 ? "" : ", ") + (i == at ? value : std::string(i % 7 == 0 ? "1.0" : "0.0"));
  }
  return out;
}

// Node 1 is 2 m along x and turned by a quarter about z. The edge maps points of the source (0) to
// the target (1): X = T1^-1 T0. Information: rotation about x first, so that entry 21 is that of
// the first translation.
std::string open3d(const std::string& more = "") {
  return R"({"class_name": "PoseGraph", "edges": [{"class_name": "PoseGraphEdge", "confidence": 1.0,
"information": [)" +
         identity_with("4.0", 21) +
         R"(], "source_node_id": 0, "target_node_id": 1,
"transformation": [0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 2, 0, 1], "uncertain": false)" +
         more + R"(}], "nodes": [
{"class_name": "PoseGraphNode", "pose": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]},
{"class_name": "PoseGraphNode", "pose": [0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 2, 0, 0, 1]}]})";
}

TEST(JsonGraph, ReadsPoseGraphsOfOpen3D) {
  const TemporaryFolder scratch;
  const auto file = scratch.file("graph.json", open3d());
  EXPECT_EQ(detect_format(file), Format::g2o);
  const PoseGraph graph = read_g2o(file);
  EXPECT_THAT(graph.ids, ElementsAre(0, 1));
  ASSERT_EQ(graph.vertices.size(), 2U);
  ASSERT_EQ(graph.edges.size(), 1U);
  const Edge& edge = graph.edges[0];
  EXPECT_EQ(edge.from, 0U);
  EXPECT_EQ(edge.to, 1U);
  EXPECT_POSE_NEAR(
      edge.from_from_to, graph.vertices[0].inverse() * graph.vertices[1], 1e-12, 1e-12);
  // The 4 is that of x in node 0, which is y in node 1; 3 + 6, and a lever arm of 2 m along x for
  // pitch and yaw: 2 * 2^2.
  EXPECT_NEAR(edge.information(1, 1), 4.0, 1e-12);
  EXPECT_NEAR(edge.information.trace(), 9.0 + 8.0, 1e-9);
  EXPECT_EQ(read_trajectory(file).size(), 2U);
}

TEST(JsonGraph, ReadsRobotLogs) {
  const std::string unit = "[" + identity_with("1.0", 0) + "]";
  std::string rotation_is_four = "[" + identity_with("4.0", 0) + "]";
  const std::string a0 = std::to_string((std::int64_t{'a'} << 56) + 0);
  const std::string a1 = std::to_string((std::int64_t{'a'} << 56) + 1);
  const std::string b0 = std::to_string((std::int64_t{'b'} << 56) + 0);
  const auto pose = [](const std::string& x) {
    return R"({"type": "Pose3", "rotation": [1, 0, 0, 0], "translation": [)" + x + ", 0, 0]}";
  };
  const auto between = [&](const std::string& i, const std::string& j, const std::string& x) {
    return R"({"type": "BetweenFactorPose3", "key1": )" + i + R"(, "key2": )" + j +
           R"(, "measurement": )" + pose(x) + R"(, "covariance": )" + rotation_is_four + "}";
  };
  const TemporaryFolder scratch;
  const auto file =
      scratch.file("log.jrl",
                   R"({"initialization": {"a": {")" + a0 + "\": " + pose("0") + ", \"" + a1 +
                       "\": " + pose("1") + R"(}, "b": {")" + b0 + "\": " + pose("5") +
                       R"(}}, "measurements": {"a": [{"stamp": 0, "measurements": [
{"type": "PriorFactorPose3", "key": )" +
                       a0 + R"(, "prior": )" + pose("0.5") + R"(, "covariance": )" + unit + R"(},
{"type": "RangeFactorPose3", "key1": 1, "key2": 2, "measurement": 1.0, "covariance": [1]}]},
{"stamp": 1, "measurements": [)" +
                       between(a0, a1, "1") + R"(]}], "b": [{"stamp": 2, "measurements": [)" +
                       between(b0, a1, "-4") + R"(]}]}, "name": "two", "robots": ["a", "b"]})");
  const PoseGraph graph = read_g2o(file);
  ASSERT_EQ(graph.ids.size(), 3U);
  ASSERT_EQ(graph.vertices.size(), 3U);
  ASSERT_EQ(graph.edges.size(), 2U);
  EXPECT_NEAR(graph.edges[0].information(3, 3), 0.25, 1e-12);  // covariance of roll
  EXPECT_NEAR(graph.edges[0].information(0, 0), 1.0, 1e-12);
  EXPECT_EQ(graph.edges[1].from, 1U);  // inverted
  EXPECT_NEAR(graph.edges[1].from_from_to.translation.x(), 4.0, 1e-12);
  ASSERT_EQ(graph.priors.size(), 1U);
  EXPECT_NEAR(graph.priors[0].position.x(), 0.5, 1e-12);
  EXPECT_EQ(graph.skipped.at("RangeFactorPose3"), 1U);
}

TEST(JsonGraph, ErrorsNameTheEntry) {
  const TemporaryFolder scratch;
  const auto why = [&](std::string text) {
    try {
      read_g2o(scratch.file("graph.json", text));
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  std::string text = open3d();
  text.replace(text.find("\"source_node_id\": 0"), 19, "\"source_node_id\": 7");
  EXPECT_THAT(why(text), HasSubstr("graph.json: edge 0: refers to a node that does not exist"));
  text = open3d();
  text.replace(text.find("4.0"), 3, "-4.");
  EXPECT_NE(why(text), "");
  const std::string factor =
      R"({"measurements": {"a": [{"measurements": [{"type": "BetweenFactorPose2", "key1": KEY, "key2": 1,
"measurement": {"type": "Pose2", "x": 1, "y": 0, "theta": 0}, "covariance": [1, 0, 0, 0, 1, 0, 0, 0, 1]}]}]}})";
  for (const char* const key : {"-3", "9223372036854775808"}) {
    text = factor;
    EXPECT_THAT(why(text.replace(text.find("KEY"), 3, key)),
                HasSubstr("graph.json: robot a, entry 0: key " + std::string(key) +
                          ": keys are numbers of GTSAM, from 0"));
  }
  EXPECT_THAT(
      why(R"({"initialization": {"a": {"-3": {"type": "Pose2", "x": 0, "y": 0, "theta": 0}}},
"measurements": {}})"),
      HasSubstr("key -3: keys are numbers of GTSAM"));
  text = factor;
  EXPECT_THAT(why(text.replace(text.find("KEY"), 3, "1")),
              HasSubstr("connects vertex 1 to itself"));
  EXPECT_THAT(why(open3d().substr(0, 200)), HasSubstr("is not valid JSON"));
}

}  // namespace
}  // namespace loopbench::test::json_graph_test

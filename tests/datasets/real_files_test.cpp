/// Reads all real trajectories and pose graphs in the folder LOOPBENCH_DATA.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

#include "datasets/formats/formats.hpp"
#include "datasets/formats/g2o.hpp"
#include "tests/datasets/scratch.hpp"
#include "tests/support/tolerance.hpp"

namespace loopbench::real_files_test {
namespace {

class RealFiles : public testing::Test {
 protected:
  void SetUp() override {
    const char* root = std::getenv("LOOPBENCH_DATA");
    if (root == nullptr) GTEST_SKIP() << "LOOPBENCH_DATA does not say where real data lies";
    root_ = root;
  }

  /// Reads a file, or skips it if it is missing in a partial copy of the data.
  void expect_rows(const std::string& name, std::size_t rows, Format format, Repeats repeats = {}) {
    const auto file = root_ / name;
    if (!std::filesystem::exists(file)) {
      absent_ += " " + name;
      return;
    }
    ReadOptions options;
    options.repeats = repeats;
    EXPECT_EQ(detect_format(file), format) << name;
    Trajectory poses;
    ASSERT_NO_THROW(poses = read_trajectory(file, options))
        << refusal([&] { read_trajectory(file, options); });
    EXPECT_EQ(poses.size(), rows) << name;
    EXPECT_NO_THROW(check(poses, name));
  }

  void expect_graph(const std::string& name,
                    std::size_t ids,
                    std::size_t vertices,
                    std::size_t edges,
                    bool is_planar) {
    const auto file = root_ / name;
    if (!std::filesystem::exists(file)) {
      absent_ += " " + name;
      return;
    }
    PoseGraph graph;
    ASSERT_NO_THROW(graph = read_g2o(file)) << refusal([&] { read_g2o(file); });
    EXPECT_EQ(detect_format(file), Format::g2o) << name;
    EXPECT_EQ(graph.ids.size(), ids) << name;
    EXPECT_EQ(graph.vertices.size(), vertices) << name;
    EXPECT_EQ(graph.edges.size(), edges) << name;
    EXPECT_EQ(graph.planar, is_planar) << name;
    for (const Edge& edge : graph.edges) ASSERT_LT(edge.from, edge.to) << name;
    if (vertices == 0) EXPECT_EQ(chain(graph).size(), ids) << name;
    const TemporaryFolder scratch;
    write_g2o(scratch.path() / "again.g2o", graph);
    EXPECT_EQ(read_g2o(scratch.path() / "again.g2o").edges.size(), edges) << name;
  }

  void TearDown() override {
    if (!absent_.empty()) GTEST_SKIP() << "missing:" << absent_;
  }

  std::filesystem::path root_;
  std::string absent_;
};

TEST_F(RealFiles, HaveTheSizesOfTheirIndex) {
  std::ifstream manifest(sample("real_files.txt"));
  std::size_t files = 0;
  for (std::string line; std::getline(manifest, line);) {
    if (line.starts_with('#')) continue;
    ++files;
    std::istringstream columns(line);
    std::string name, format, plane;
    std::size_t rows = 0, vertices = 0, edges = 0;
    columns >> name >> format >> rows;
    if (format == "g2o") {
      columns >> vertices >> edges >> plane;
      expect_graph(name, rows, vertices, edges, plane == "planar");
    } else {
      expect_rows(name, rows, from_text<Format>(format).value());
    }
    EXPECT_FALSE(columns.fail()) << line;
  }
  EXPECT_EQ(files, 64u);
}

TEST_F(RealFiles, TwoPublishedFilesRepeatStampsAndNeedTheSwitch) {
  const auto desk = root_ / "tum_rgbd/other/fr2_desk/groundtruth.txt";
  const auto euroc = root_ / "euroc/V102/estimate.txt";
  if (!std::filesystem::exists(desk) || !std::filesystem::exists(euroc)) {
    GTEST_SKIP() << "missing: " << desk << " or " << euroc;
  }
  EXPECT_EQ(refusal([&] { read_trajectory(desk); }),
            desk.string() +
                ":10863: stamp 1311868229.576 is already on line 10862, expected "
                "increasing stamps (or repeats: keep_first, keep_last)");
  EXPECT_NE(refusal([&] { read_trajectory(euroc); }).find(":433: stamp"), std::string::npos);
  expect_rows("tum_rgbd/other/fr2_desk/groundtruth.txt", 20956, Format::tum, Repeats::keep_first);
  expect_rows("euroc/V102/estimate.txt", 803, Format::tum, Repeats::keep_first);
}

TEST_F(RealFiles, ToroEdgesEqualTheirG2oTwins) {
  const auto toro_file = root_ / "pose_graphs/sphere2500_noisy_edges.txt";
  const auto twin_file = root_ / "pose_graphs/sphere2500.g2o";
  if (!std::filesystem::exists(toro_file)) GTEST_SKIP() << "missing: " << toro_file;
  PoseGraph toro = read_g2o(toro_file);
  PoseGraph twin = read_g2o(twin_file);
  for (PoseGraph* graph : {&toro, &twin}) {  // the same edges in another order
    std::sort(graph->edges.begin(), graph->edges.end(), [](const Edge& a, const Edge& b) {
      return std::pair(a.from, a.to) < std::pair(b.from, b.to);
    });
  }
  ASSERT_EQ(toro.edges.size(), twin.edges.size());
  Twist toro_sum = Twist::Zero(), twin_sum = Twist::Zero();
  for (std::size_t i = 0; i < toro.edges.size(); ++i) {
    const Edge& a = toro.edges[i];
    const Edge& b = twin.edges[i];
    ASSERT_EQ(a.from, b.from);
    ASSERT_EQ(a.to, b.to);
    ASSERT_POSE_NEAR(a.from_from_to, b.from_from_to, 1e-12, 5e-6) << i;  // six digits printed
    toro_sum += a.information.diagonal();
    twin_sum += b.information.diagonal();
  }
  // The information of roll and pitch is four times that of yaw in both: the axes have the same
  // order.
  EXPECT_TRUE(toro_sum.isApprox(twin_sum, 0.02)) << toro_sum << "\n\n" << twin_sum;
}

TEST_F(RealFiles, TheHagueLoopSaysHowTheUnitGrew) {
  const auto file = root_ / "cop_slam/TheHague_02_vo.g2o";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "missing: " << file;
  const PoseGraph graph = read_g2o(file);
  const Edge& loop = graph.edges.back();
  EXPECT_EQ(loop.from, 0u);
  EXPECT_EQ(loop.to, 839u);
  EXPECT_NEAR(loop.scale, 3.099978, 1e-12);
  // Scale with respect to the ground truth over 40 steps: 0.86 m at the start, 2.6 m at the end.
  const PoseGraph truth = read_g2o(root_ / "cop_slam/TheHague_02_gt.g2o");
  const auto unit = [&](std::size_t begin, std::size_t end) {
    double measured = 0.0, metres = 0.0;
    for (std::size_t i = begin; i < end; ++i) {
      measured += (graph.vertices[i + 1].translation - graph.vertices[i].translation).norm();
      metres += (truth.vertices[i + 1].translation - truth.vertices[i].translation).norm();
    }
    return metres / measured;
  };
  EXPECT_NEAR(unit(799, 839) / unit(0, 40), loop.scale, 0.5);
}

}  // namespace
}  // namespace loopbench::real_files_test

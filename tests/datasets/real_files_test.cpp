/// Reads all real trajectories and pose graphs in the folder LOOPBENCH_DATA.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <tuple>

#include "datasets/formats/formats.hpp"
#include "datasets/formats/g2o.hpp"
#include "tests/datasets/scratch.hpp"

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

TEST_F(RealFiles, TwoPublishedFilesRepeatStampsWithAgreeingPoses) {
  for (const auto& [name, rows, agreeing] :
       {std::tuple{"tum_rgbd/other/fr2_desk/groundtruth.txt", 20956u, 1u},
        std::tuple{"euroc/V102/estimate.txt", 803u, 4u}}) {
    const auto file = root_ / name;
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "missing: " << file;
    ReadFindings findings;
    EXPECT_EQ(read_trajectory(file, {.findings = &findings}).size(), rows) << name;
    EXPECT_EQ(findings.agreeing, agreeing) << name;
    expect_rows(name, rows, Format::tum, Repeats::keep_first);
  }
}

}  // namespace
}  // namespace loopbench::real_files_test

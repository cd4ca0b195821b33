/// Reads all real trajectories and pose graphs in the folder LOOPBENCH_DATA.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

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

  void TearDown() override {
    if (!absent_.empty()) GTEST_SKIP() << "missing:" << absent_;
  }

  std::filesystem::path root_;
  std::string absent_;
};

TEST_F(RealFiles, TumHasTheIndexedRows) {
  const std::pair<const char*, std::size_t> files[] = {
      {"tum_rgbd/fr1_room/groundtruth.txt", 4887},
      {"tum_rgbd/fr1_room/orbslam2_rgbd_open_keyframes.txt", 236},
      {"tum_rgbd/fr1_room/orbslam2_rgbd_open_frames.txt", 1352},
      {"tum_rgbd/fr1_room/orbslam2_rgbd_closed_frames_run0.txt", 1352},
      {"tum_rgbd/fr1_room/orbslam2_rgbd_closed_frames_run1.txt", 1352},
      {"tum_rgbd/fr1_room/rgbdslam_frames.txt", 1332},
      {"tum_rgbd/fr1_room/orbslam2_mono_keyframes.txt", 82},
      {"tum_rgbd/fr3_office/groundtruth.txt", 8710},
      {"tum_rgbd/fr3_office/orbslam2_rgbd_closed_frames_run0.txt", 2488},
      {"tum_rgbd/fr3_office/orbslam2_rgbd_closed_frames_run1.txt", 2488},
      {"tum_rgbd/fr3_office/orbslam2_mono_open_frames.txt", 2557},
      {"tum_rgbd/fr3_office/orbslam2_mono_closed_frames.txt", 2558},
      {"tum_rgbd/fr3_office/orbslam2_mono_open_keyframes.txt", 205},
      {"tum_rgbd/fr3_office/orbslam2_mono_open_keyframes_run_frames.txt", 2558},
      {"tum_rgbd/fr3_office/orbslam2_mono_large_drift_keyframes.txt", 213},
      {"tum_rgbd/other/fr1_360/groundtruth.txt", 2870},
      {"tum_rgbd/other/fr1_desk/groundtruth.txt", 2335},
      {"tum_rgbd/other/fr1_desk/orbslam2_rgbd_frames.txt", 573},
      {"tum_rgbd/other/fr1_plant/groundtruth.txt", 4124},
      {"tum_rgbd/other/fr1_xyz/groundtruth.txt", 3000},
      {"tum_rgbd/other/fr2_desk/orbslam_frames_evo.txt", 2893},
      {"tum_rgbd/other/fr2_desk/orbslam_mono_kf_evo.txt", 157},
      {"kitti/07/gt_tum.txt", 1101},
      {"kitti/07/orbslam2_mono_open_frames_ej.txt", 1095},
      {"kitti/07/orbslam2_mono_open_frames_lx.txt", 1096},
      {"kitti/07/orbslam2_mono_closed_frames_ej.txt", 1096},
      {"kitti/07/orbslam2_mono_closed_frames_lx.txt", 1096},
      {"kitti/07/orbslam2_mono_open_keyframes_cx.txt", 504},
      {"kitti/07/orbslam2_mono_closed_keyframes_cx.txt", 494},
      {"rgbd/seven_scenes/groundtruth.txt", 1000},
  };
  for (const auto& [name, rows] : files) expect_rows(name, rows, Format::tum);
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

TEST_F(RealFiles, KittiAndEurocHaveTheIndexedRows) {
  const std::pair<const char*, std::size_t> sequences[] = {
      {"00", 4541}, {"06", 1101}, {"07", 1101}};
  for (const auto& [sequence, rows] : sequences) {
    const std::string folder = std::string("kitti/") + sequence + "/";
    for (const char* name : {"gt_poses", "imls_lidar_odom_open", "loam_open", "orbslam2_stereo"}) {
      expect_rows(folder + name + ".txt", rows, Format::kitti);
    }
  }
  expect_rows("kitti/00/sptam_stereo_open.txt", 4541, Format::kitti);
  expect_rows("euroc/V102/state_groundtruth_estimate0.csv", 16702, Format::euroc);
}

struct Graph {
  const char* name;
  std::size_t ids, vertices, edges;
  bool planar;
};

TEST_F(RealFiles, PoseGraphsHaveTheIndexedSizes) {
  const Graph graphs[] = {
      {"cop_slam/KITTI_00_vo.g2o", 4541, 4541, 4549, false},
      {"cop_slam/KITTI_00_gt.g2o", 4541, 4541, 0, false},
      {"cop_slam/TheHague_02_vo.g2o", 840, 840, 840, false},
      {"cop_slam/TheHague_02_gt.g2o", 840, 840, 0, false},
      {"robust_slam/00/kitti_00_GT.g2o", 4541, 0, 4540, true},
      {"robust_slam/00/kitti_00_alpha_0.00.g2o", 4541, 0, 4987, true},
      {"robust_slam/00/kitti_00_alpha_0.50.g2o", 4541, 0, 4877, true},
      {"robust_slam/00/kitti_00_alpha_1.00.g2o", 4541, 0, 4681, true},
      {"kitti/00/viso2_loops_se2.g2o", 4541, 0, 4676, true},
      {"kitti/06/viso2_loops_se2.g2o", 1101, 0, 1150, true},
      {"kitti/07/viso2_loops_se2.g2o", 1101, 0, 1106, true},
      {"pose_graphs/intel.g2o", 1728, 1728, 2512, true},
      {"pose_graphs/INTEL_1228_with_vertices.g2o", 1228, 1228, 1483, true},
      {"pose_graphs/M3500_with_vertices.g2o", 3500, 3500, 5453, true},
      {"pose_graphs/parking-garage.g2o", 1661, 1661, 6275, false},
      {"pose_graphs/smallGrid3D.g2o", 125, 125, 297, false},
      {"pose_graphs/sphere2500.g2o", 2500, 2500, 4949, false},
      {"pose_graphs/sphere2500_noisy_edges.txt", 2500, 0, 4949, false},
      {"pose_graphs/sphere2500_true_edges.txt", 2500, 0, 4949, false},
      {"pose_graphs/torus3D.g2o", 5000, 5000, 9048, false},
  };
  for (const Graph& expected : graphs) {
    const auto file = root_ / expected.name;
    if (!std::filesystem::exists(file)) {
      absent_ += std::string(" ") + expected.name;
      continue;
    }
    PoseGraph graph;
    ASSERT_NO_THROW(graph = read_g2o(file)) << refusal([&] { read_g2o(file); });
    EXPECT_EQ(detect_format(file), Format::g2o) << expected.name;
    EXPECT_EQ(graph.ids.size(), expected.ids) << expected.name;
    EXPECT_EQ(graph.vertices.size(), expected.vertices) << expected.name;
    EXPECT_EQ(graph.edges.size(), expected.edges) << expected.name;
    EXPECT_EQ(graph.planar, expected.planar) << expected.name;
    for (const Edge& edge : graph.edges) ASSERT_LT(edge.from, edge.to) << expected.name;
    if (expected.vertices == 0) {
      EXPECT_EQ(chain(graph).size(), expected.ids) << expected.name;
    }
    const TemporaryFolder scratch;
    write_g2o(scratch.path() / "again.g2o", graph);
    EXPECT_EQ(read_g2o(scratch.path() / "again.g2o").edges.size(), expected.edges) << expected.name;
  }
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

TEST_F(RealFiles, ChainingOdometryGivesTheWrittenVertices) {
  const auto file = root_ / "cop_slam/KITTI_00_vo.g2o";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "missing: " << file;
  const PoseGraph graph = read_g2o(file);
  const std::vector<Pose> poses = chain(graph);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    ASSERT_POSE_NEAR(poses[i], graph.vertices[i], 0.2, 0.002) << i;  // six digits over 3.7 km
  }
}

}  // namespace
}  // namespace loopbench::real_files_test

/// Compares results on published files with known values. Skipped if the files are missing.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdlib>

#include "datasets/dataset.hpp"
#include "datasets/derive/poses_at.hpp"
#include "tests/datasets/scratch.hpp"
#include "tests/support/tolerance.hpp"

namespace loopbench::published_data_test {
namespace {

class PublishedData : public testing::Test {
 protected:
  void SetUp() override {
    const char* folder = std::getenv("LOOPBENCH_DATA");
    if (folder == nullptr) GTEST_SKIP() << "LOOPBENCH_DATA does not say where the data lies";
    root_.folders = {folder};
    for (const char* part : {"tum_rgbd", "cop_slam", "kitti", "robust_slam", "pose_graphs"}) {
      if (!std::filesystem::exists(root_.folders[0] / part)) {
        GTEST_SKIP() << "LOOPBENCH_DATA has no folder " << part;
      }
    }
  }

  Sequence load(const std::string& name, const Params& given) {
    return load_dataset(name, given, root_);
  }

  DataRoot root_;
};

/// Position RMSE [m] after least-squares alignment (rigid or similarity). Each pose is paired with
/// the nearest reference pose within 0.02 s.
double ate(const Trajectory& estimate, const Trajectory& reference, bool with_scale = false) {
  std::vector<Vector3> from;
  std::vector<Vector3> to;
  for (const auto& [stamp, pose] : estimate) {
    const auto nearest = nearest_pose(reference, stamp, 0.02);
    if (!nearest) continue;
    from.push_back(pose.translation);
    to.push_back(reference[*nearest].world_from_body.translation);
  }
  const auto matrix = [](const std::vector<Vector3>& points) {
    return Eigen::Map<const Eigen::Matrix3Xd>(points[0].data(), 3, Eigen::Index(points.size()));
  };
  const Eigen::Matrix4d fit = Eigen::umeyama(matrix(from), matrix(to), with_scale);
  const Eigen::Matrix3Xd moved =
      (fit.topLeftCorner<3, 3>() * matrix(from)).colwise() + Vector3(fit.topRightCorner<3, 1>());
  return std::sqrt((moved - matrix(to)).colwise().squaredNorm().mean());
}

/// Median over closures of |translation| [m] and angle [rad] of measured^-1 * reference.
std::pair<double, double> closure_residual(const Sequence& sequence) {
  const Trajectory& keyframes = sequence.problem.keyframes;
  const auto reference = poses_at(sequence.reference, stamps(keyframes), {});
  std::vector<double> metres;
  std::vector<double> radians;
  for (const Edge& closure : sequence.problem.closures) {
    const auto& from = reference[closure.from];
    const auto& to = reference[closure.to];
    if (!from || !to) continue;
    const Pose error = closure.from_from_to.inverse() * (from->inverse() * *to);
    metres.push_back(error.translation.norm());
    radians.push_back(log_so3(error.rotation).norm());
  }
  if (metres.empty()) return {1e9, 1e9};
  std::sort(metres.begin(), metres.end());
  std::sort(radians.begin(), radians.end());
  return {metres[metres.size() / 2], radians[radians.size() / 2]};
}

Params fr1_room() {
  return {{"estimate", "tum_rgbd/fr1_room/orbslam2_rgbd_open_keyframes.txt"},
          {"frames", "tum_rgbd/fr1_room/orbslam2_rgbd_open_frames.txt"},
          {"reference", "tum_rgbd/fr1_room/groundtruth.txt"}};
}

TEST_F(PublishedData, Fr1RoomOpenKeyframes) {
  const Sequence sequence = load("trajectory", fr1_room());
  EXPECT_EQ(sequence.name, "fr1_room_orbslam2_rgbd_open_keyframes");
  EXPECT_EQ(sequence.problem.keyframes.size(), 236u);
  EXPECT_EQ(sequence.problem.odometry.size(), 235u);
  EXPECT_EQ(sequence.problem.frames.size(), 1095u);  // of 1352; 21 are after the last keyframe
  EXPECT_NEAR(ate(sequence.problem.keyframes, sequence.reference), 0.109, 0.0005);
}

TEST_F(PublishedData, Fr1RoomClosuresOfAClosedRunAgreeWithTheReference) {
  Params given = fr1_room();
  given["closures.source"] = "estimate";
  given["closures.file"] = "tum_rgbd/fr1_room/orbslam2_rgbd_closed_frames_run1.txt";
  Sequence sequence = load("trajectory", given);
  EXPECT_EQ(sequence.problem.closures.size(), 20u);
  EXPECT_FALSE(sequence.provenance.oracle_closures);
  const auto [metres, radians] = closure_residual(sequence);
  EXPECT_LT(metres, 0.03);
  EXPECT_LT(radians, 0.03);

  const Trajectory& keyframes = sequence.problem.keyframes;
  for (Edge& closure :
       sequence.problem.closures) {  // relative poses of the run without loop closing
    closure.from_from_to =
        keyframes[closure.from].world_from_body.inverse() * keyframes[closure.to].world_from_body;
  }
  EXPECT_GT(closure_residual(sequence).first, 0.2);

  given["closures.max"] = std::int64_t{0};
  EXPECT_EQ(load("trajectory", given).problem.closures.size(), 65u);
}

TEST_F(PublishedData, CopSlamKitti00EveryTenth) {
  Params given = {{"path", "cop_slam/KITTI_00_vo.g2o"}, {"truth", "cop_slam/KITTI_00_gt.g2o"}};
  const Sequence all = load("pose_graph", given);
  EXPECT_EQ(all.problem.keyframes.size(), 4541u);
  EXPECT_NEAR(ate(all.problem.keyframes, all.reference), 31.5, 0.05);
  given["keyframes.every"] = std::int64_t{10};
  const Sequence sequence = load("pose_graph", given);
  EXPECT_EQ(sequence.problem.keyframes.size(), 470u);
  EXPECT_EQ(sequence.problem.closures.size(), 9u);
  EXPECT_NEAR(ate(sequence.problem.keyframes, sequence.reference), 31.5, 0.05);
  const Trajectory& keyframes = sequence.problem.keyframes;
  for (const Edge& edge :
       sequence.problem.odometry) {  // the vertices of the file are the composed odometry
    const Pose step =
        keyframes[edge.from].world_from_body.inverse() * keyframes[edge.to].world_from_body;
    EXPECT_POSE_NEAR(edge.from_from_to, step, 1e-4, 1e-4);
  }
}

TEST_F(PublishedData, CopSlamTheHagueIsASimilarityChain) {
  const Sequence sequence =
      load("pose_graph",
           {{"path", "cop_slam/TheHague_02_vo.g2o"}, {"truth", "cop_slam/TheHague_02_gt.g2o"}});
  const Trajectory& keyframes = sequence.problem.keyframes;
  EXPECT_EQ(keyframes.size(), 840u);
  ASSERT_EQ(sequence.problem.closures.size(), 1u);
  EXPECT_NEAR(sequence.problem.closures[0].scale, 3.1, 1e-3);
  EXPECT_NEAR(ate(keyframes, sequence.reference), 45.6, 0.05);
  EXPECT_NEAR(ate(keyframes, sequence.reference, true), 31.5, 0.05);
}

TEST_F(PublishedData, KittiVisoLoopsAndTurnedTruth) {
  struct Known {
    std::string number;
    std::size_t poses;
    std::size_t closures;
    double raw_ate;           // [m]
    double closure_residual;  // [m]
  };
  for (const Known& known : {Known{"00", 4541, 136, 20.6, 0.5},
                             Known{"06", 1101, 50, 3.2, 0.1},
                             Known{"07", 1101, 6, 3.1, 0.1}}) {
    const std::string folder = "kitti/" + known.number;
    const Sequence sequence = load("pose_graph",
                                   {{"path", folder + "/viso2_loops_se2.g2o"},
                                    {"truth", folder + "/gt_poses.txt"},
                                    {"truth_axes", "kitti_camera"}});
    EXPECT_TRUE(sequence.problem.planar);
    EXPECT_EQ(sequence.problem.keyframes.size(), known.poses);
    EXPECT_EQ(sequence.problem.closures.size(), known.closures);
    EXPECT_NEAR(ate(sequence.problem.keyframes, sequence.reference), known.raw_ate, 0.05);
    // Relative poses agree only if both bodies have the same axes.
    EXPECT_LT(closure_residual(sequence).first, known.closure_residual);
    EXPECT_LT(closure_residual(sequence).second, 0.02);
  }
}

TEST_F(PublishedData, RobustSlamPlaceholdersAreAllItsFalseLoops) {
  struct Known {
    std::string alpha;
    std::size_t all;
    std::size_t measured;
  };
  for (const Known& known :
       {Known{"0.00", 447, 118}, Known{"0.50", 337, 120}, Known{"1.00", 141, 131}}) {
    const std::string base = "robust_slam/00/kitti_00_alpha_" + known.alpha;
    Params given = {{"path", base + ".g2o"}, {"truth", "robust_slam/00/kitti_00_GT.g2o"}};
    const Sequence all = load("pose_graph", given);
    EXPECT_EQ(all.problem.closures.size(), known.all);
    EXPECT_NEAR(ate(all.problem.keyframes, all.reference), 21.03, 0.005);
    Params listed = given;
    listed["closures.true_list"] = base + "_GT_LC.txt";
    given["closures.skip_placeholders"] = true;
    EXPECT_EQ(load("pose_graph", given).problem.closures.size(), known.measured);
    EXPECT_EQ(load("pose_graph", listed).problem.closures.size(), known.measured);
  }
}

}  // namespace
}  // namespace loopbench::published_data_test

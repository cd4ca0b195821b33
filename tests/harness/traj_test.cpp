// `traj` follows evo's semantics; golden numbers of evo are in tests/data/golden.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "datasets/formats/trajectory_file.hpp"
#include "harness/commands/files/named_trajectory.hpp"
#include "harness/commands/files/trajectory_selection.hpp"
#include "harness/commands/files/transformation.hpp"
#include "tests/support/eval_command.hpp"
#include "tests/support/temporary_folder.hpp"

namespace loopbench::test::traj_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Output of `loopbench traj ARGS`, which must succeed.
std::string traj(const std::vector<std::string>& arguments) {
  return test::in_process("traj", arguments);
}

TEST(Traj, AFolderOfABagTakesTf) {
  const char* const data = std::getenv("LOOPBENCH_DATA");
  if (data == nullptr) GTEST_SKIP() << "needs LOOPBENCH_DATA";
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() / "bag");
  std::filesystem::copy(std::filesystem::path(data) / "bags" / "tf_example.db3",
                        folder.path() / "bag");
  EXPECT_THAT(traj({"info", (folder.path() / "bag").string(), "--tf", "odom.base_link"}),
              HasSubstr("tf:odom.base_link"));
}

TEST(Traj, AlignMovesThePosesAsEvo) {
  const TemporaryFolder folder;
  for (const auto& [how, expected] : {std::pair{"se3", 0.676208260682124},
                                      std::pair{"sim3", 0.660473127811482},
                                      std::pair{"origin", 2.12100433850654}}) {
    const std::string out = (folder.path() / how).string();
    traj({"align", golden("est_drift.txt"), "--ref", golden("gt.txt"), "--align", how, "-o", out});
    EXPECT_EQ(read_trajectory(out).size(), 657u);  // all poses, not only the paired ones
    const test::Json json = test::eval_json({golden("gt.txt"), out, "--protocol", "evo"});
    EXPECT_NEAR(test::find(json, "ate", "translation")["rmse"].get<double>(), expected, 1e-9)
        << how;
  }
}

TEST(Traj, DownsampleTakesTheIndicesOfNumpyLinspace) {
  EXPECT_THAT(evenly_spaced(10, 4), ElementsAre(0, 3, 6, 9));
  EXPECT_THAT(evenly_spaced(11, 4), ElementsAre(0, 3, 6, 10));  // floor(3.33), floor(6.67)
  EXPECT_THAT(evenly_spaced(3, 7), ElementsAre(0, 1, 2));
  EXPECT_THAT(evenly_spaced(5, 1), ElementsAre(0));
}

Trajectory line(std::size_t count) {
  Trajectory out;
  for (std::size_t i = 0; i < count; ++i) {
    const auto at = static_cast<double>(i);
    out.push_back({at, {exp_so3({0, 0, 0.1 * at}), {0.5 * at, 0, 0}}});
  }
  return out;
}

TEST(Traj, MotionFilterKeepsAPoseWhenAThresholdIsReached) {
  EXPECT_THAT(by_motion(line(8), 1.5, 360.0), ElementsAre(0, 3, 6));
  EXPECT_THAT(by_motion(line(8), 100.0, 22.0), ElementsAre(0, 4));
  EXPECT_THAT(by_motion(line(8), 1.5, 6.0), ElementsAre(0, 2, 4, 6));
  // The angle counts from the last kept pose to this one: rotating to and fro reaches nothing.
  Trajectory nodding = line(8);
  for (std::size_t i = 0; i < nodding.size(); ++i) {
    nodding[i].world_from_body.rotation = exp_so3({0, 0, i % 2 == 0 ? 0.0 : 0.3});
  }
  EXPECT_THAT(by_motion(nodding, 100.0, 20.0), ElementsAre(0));
}

TEST(Traj, TransformIsAppliedLeftRightOrToTheSteps) {
  const Similarity quarter{{exp_so3({0, 0, M_PI / 2}), {1, 0, 0}}, 1.0};
  const Trajectory left = transformed(line(2), quarter, TransformSide::left);
  EXPECT_TRUE(left[1].world_from_body.translation.isApprox(Vector3(1, 0.5, 0)));
  const Trajectory right = transformed(line(2), quarter, TransformSide::right);
  EXPECT_NEAR(right[1].world_from_body.translation.x(), 0.5 + std::cos(0.1), 1e-12);
  const Similarity drift{{Rotation::Identity(), {0, 0.01, 0}}, 1.0};
  EXPECT_NEAR(transformed(line(1), drift, TransformSide::right_propagated)[0]
                  .world_from_body.translation.y(),
              0.0,
              1e-15);
  const Trajectory back =
      transformed(transformed(line(3), {quarter.pose, 2.0}, TransformSide::left),
                  inverse(Similarity{quarter.pose, 2.0}),
                  TransformSide::left);
  EXPECT_TRUE(back[2].world_from_body.translation.isApprox(Vector3(1.0, 0, 0), 1e-12));
}

TEST(Traj, RejectsWhatNeedsRotations) {
  const Trajectory positions{{0, {no_rotation(), {0, 0, 0}}}, {1, {no_rotation(), {1, 0, 0}}}};
  EXPECT_THROW(by_motion(positions, 0.5, 5.0), InputError);
  EXPECT_EQ(by_motion(positions, 0.5, 360.0).size(), 2u);
  EXPECT_THROW(transformed(positions, Similarity{}, TransformSide::right), InputError);
  EXPECT_TRUE(lacks_rotations(transformed(positions, Similarity{}, TransformSide::left)));
}

TEST(Traj, TransformReadsEvosJson) {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "t.json").string();
  std::ofstream(file)
      << R"({"x": 1, "y": 2, "z": 3, "qx": 0, "qy": 0, "qz": 0, "qw": 1, "scale": 2})";
  EXPECT_EQ(read_similarity(file).scale, 2.0);
  EXPECT_EQ(read_similarity("1,2,3").pose.translation, Vector3(1, 2, 3));
  std::ofstream(file) << R"({"x": 1})";
  EXPECT_THROW(read_similarity(file), InputError);
  EXPECT_THROW(read_similarity("1,2"), InputError);
}

TEST(Traj, NamesOutputsByTheirInputs) {
  EXPECT_EQ(output_stem("bag:x.bag#/robot/odom"), "robot_odom");
  EXPECT_EQ(output_stem("a/b.txt.gz"), "b");
}

}  // namespace
}  // namespace loopbench::test::traj_test

// `traj` follows evo's semantics; golden numbers of evo are in tests/data/golden.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "datasets/formats/trajectory_file.hpp"
#include "harness/eval/named_trajectory.hpp"
#include "harness/eval/trajectory_selection.hpp"
#include "harness/eval/transformation.hpp"
#include "tests/support/command.hpp"
#include "tests/support/eval_command.hpp"

namespace loopbench::traj_test {
namespace {

using test::golden;
using testing::ElementsAre;
using testing::HasSubstr;
using namespace harness;

/// Output of `loopbench traj ARGS`, which must succeed.
std::string traj(const std::vector<std::string>& arguments) { return test::traj(arguments).output; }

using test::traj_refusal;

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

TEST(Traj, AlignPrintsTheTransformAsEval) {
  const TemporaryFolder folder;
  const std::string out = (folder.path() / "aligned.txt").string();
  const std::string file = golden("est_drift.txt"), reference = golden("gt.txt");
  const auto json = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"align", file, "--ref", reference, "--align", "sim3"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const test::Printed printed = test::traj(arguments);
    EXPECT_EQ(printed.errors, "");
    return test::Json::parse(printed.output);
  };
  const test::Json fit = json({"--json"}).at(0);
  const test::Json evaluated =
      test::eval_json({reference, file, "--protocol", "evo", "--align", "sim3"});
  for (const char* key : {"reference", "estimate", "pairs", "alignment"}) {
    EXPECT_EQ(fit.at(key), evaluated.at(key)) << key;
  }
  EXPECT_EQ(json({"--json", "-o", out}).at(0), fit);
  EXPECT_EQ(json({"--json", "--n_to_align", "100"}).at(0).at("pairs"), 100);
  EXPECT_EQ(read_trajectory(out).size(), 657u);
}

TEST(Traj, DownsampleTakesTheIndicesOfNumpyLinspace) {
  EXPECT_THAT(evenly_spaced(10, 4), ElementsAre(0, 3, 6, 9));
  EXPECT_THAT(evenly_spaced(11, 4), ElementsAre(0, 3, 6, 10));  // floor(3.33), floor(6.67)
  EXPECT_THAT(evenly_spaced(3, 7), ElementsAre(0, 1, 2));
  EXPECT_THAT(evenly_spaced(5, 1), ElementsAre(0));
  const TemporaryFolder folder;
  const std::string out = (folder.path() / "some.txt").string();
  traj({"convert", golden("est_drift.txt"), "--downsample", "100", "-o", out});
  EXPECT_EQ(read_trajectory(out).size(), 100u);
  EXPECT_EQ(read_trajectory(out).back().stamp,
            read_trajectory(golden("est_drift.txt")).back().stamp);
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

TEST(Traj, CropAndMerge) {
  const TemporaryFolder folder;
  const auto path = [&](const char* name) { return (folder.path() / name).string(); };
  traj({"crop", golden("gt.txt"), "--relative", "--end", "10", "-o", path("a.txt")});
  traj({"crop", golden("gt.txt"), "--relative", "--start", "5", "-o", path("b.txt")});
  traj({"merge", path("a.txt"), path("b.txt"), "-o", path("all.txt")});
  EXPECT_EQ(read_trajectory(path("all.txt")).size(), 1995u);
}

TEST(Traj, ConvertSelectsShiftsAndProjects) {
  const TemporaryFolder folder;
  const std::string out = (folder.path() / "flat.txt").string();
  const auto converted = [&](const std::vector<std::string>& options) {
    std::vector<std::string> arguments{"convert", golden("gt.txt"), "-o", out};
    arguments.insert(arguments.end(), options.begin(), options.end());
    traj(arguments);
    return read_trajectory(out);
  };
  const Trajectory whole = read_trajectory(golden("gt.txt"));
  const Trajectory all = converted({"--project_to_plane", "xy"});
  EXPECT_EQ(all.size(), whole.size());
  for (const StampedPose& pose : all) {
    ASSERT_EQ(pose.world_from_body.translation.z(), 0.0);
    ASSERT_NEAR(log_so3(pose.world_from_body.rotation).head<2>().norm(), 0.0, 1e-12);
  }
  // Poses are selected by their motion in space, before they are projected.
  const std::vector<std::size_t> kept = by_motion(whole, 0.2, 3.0);
  const Trajectory few =
      converted({"--project_to_plane", "xy", "--offset", "0.5", "--motion_filter", "0.2", "3"});
  ASSERT_EQ(few.size(), kept.size());
  for (std::size_t i = 0; i < few.size(); ++i) {
    EXPECT_NEAR(few[i].stamp, whole[kept[i]].stamp + 0.5, 1e-6);
    EXPECT_EQ(few[i].world_from_body.translation, all[kept[i]].world_from_body.translation);
  }
  EXPECT_EQ(converted({"--motion_filter", "0.2", "3", "--downsample", "10"}).size(),
            by_motion(converted({"--downsample", "10"}), 0.2, 3.0).size());
  EXPECT_EQ(converted({"--project_to_plane", "none"})[1].world_from_body.translation,
            whole[1].world_from_body.translation);
  EXPECT_EQ(traj_refusal({"convert", golden("gt.txt"), "--project_to_plane", "zz"}),
            "project_to_plane = zz: expected one of none | xy | xz | yz");
}

TEST(Traj, CountsOnePose) {
  const TemporaryFolder folder;
  folder.file("a.txt", "1 0 0 0 0 0 0 1\n");
  EXPECT_EQ(loopbench_command("traj convert a.txt -o b.txt", folder).out, "b.txt: 1 pose\n");
}

TEST(Traj, InfoPrintsSizeSpeedAndGaps) {
  const test::Json info = test::Json::parse(traj({"info", golden("gt.txt"), "--json"}))[0];
  EXPECT_EQ(info["poses"], 1995);
  EXPECT_NEAR(info["rate"].get<double>(), 50.0, 0.5);
  EXPECT_THAT(traj({"info", golden("gt.txt")}), HasSubstr("bounding box"));
}

TEST(Traj, SeveralFilesNeedAFolderWithOneFileEach) {
  EXPECT_THAT(traj_refusal({"convert", golden("gt.txt"), golden("est_drift.txt")}),
              HasSubstr("-o: found several trajectories, expected a folder"));
  EXPECT_THAT(output_stem("bag:x.bag#/robot/odom"), "robot_odom");
  EXPECT_THAT(output_stem("a/b.txt.gz"), "b");
  const TemporaryFolder folder;
  EXPECT_THAT(
      traj_refusal({"convert", golden("gt.txt"), golden("gt.txt"), "-o", folder.path().string()}),
      HasSubstr("would be written twice"));
  const std::string out = (folder.path() / "one.txt").string();
  EXPECT_THAT(traj_refusal({"convert", golden("gt.txt"), golden("est_drift.txt"), "-o", out}),
              HasSubstr("found several trajectories and the file"));
  EXPECT_FALSE(std::filesystem::exists(out));
  traj({"convert", golden("gt.txt"), golden("est_drift.txt"), "-o", out + "/"});
  EXPECT_TRUE(std::filesystem::exists(out + "/gt.txt"));
}

TEST(Traj, PipesConnectVerbs) {
  const std::string program = "'" LOOPBENCH_BINARY "' traj ";
  const std::string line = program + "crop '" + golden("gt.txt") + "' --relative --end 1 | " +
                           program + "convert - --to euroc";
  std::FILE* const pipe = popen(line.c_str(), "r");
  ASSERT_NE(pipe, nullptr);
  std::array<char, 64> text{};
  const std::size_t count = std::fread(text.data(), 1, text.size() - 1, pipe);
  pclose(pipe);
  EXPECT_THAT(std::string(text.data(), count), HasSubstr("# timestamp [ns],p_x [m]"));
}

TEST(Traj, TransformChangesConventions) {
  const TemporaryFolder folder;
  const std::string in = folder.file("in.txt", "2000 1000 2000 3000 0.5 0.1 0.7 0.5\n").string();
  const auto transformed_by = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {"transform", in, "-o", "-"});
    std::istringstream words(traj(options));
    std::vector<double> out;
    for (double value = 0; words >> value;) out.push_back(value);
    return out;
  };
  using testing::DoubleEq;
  EXPECT_THAT(
      transformed_by({"--stamp-scale", "0.001", "--scale", "0.001", "--axes=-y,x,z"}),
      testing::Pointwise(testing::DoubleNear(1e-12), {2.0, -2.0, 1.0, 3.0, 0.5, 0.1, 0.7, 0.5}));
  // The components w x y z = 0.5 0.1 0.7 0.5 are written as x y z w.
  EXPECT_THAT(transformed_by({"--quaternion-order", "wxyz"}),
              testing::Pointwise(testing::DoubleNear(1e-12),
                                 {2000.0, 1000.0, 2000.0, 3000.0, 0.1, 0.7, 0.5, 0.5}));
  EXPECT_THAT(transformed_by({"--quaternion-order", "xyzw"}),
              testing::Pointwise(testing::DoubleNear(1e-12),
                                 {2000.0, 1000.0, 2000.0, 3000.0, 0.5, 0.5, 0.1, 0.7}));
  EXPECT_THAT(traj_refusal({"transform", in, "--axes=x,x,z"}), HasSubstr("--axes: found 'x,x,z'"));
}

}  // namespace
}  // namespace loopbench::traj_test

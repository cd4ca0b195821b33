#include "datasets/trajectory_dataset.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/datasets/random_poses.hpp"
#include "tests/datasets/scratch.hpp"
#include "tests/support/refusal_of.hpp"
#include "tests/support/tolerance.hpp"

namespace loopbench::trajectory_dataset_test {
namespace {

using testing::HasSubstr;

/// Moves back and forth on the x axis twice in 20 s, 201 poses.
Trajectory shuttle() {
  std::vector<double> xs;
  for (int i = 0; i <= 200; ++i) xs.push_back(1.0 - std::cos(2.0 * M_PI * i / 100.0));
  return on_a_line(xs, 0.1);
}

TrajectoryOptions every_tenth(ClosureSource source) {
  TrajectoryOptions options;
  options.keyframes = {KeyframeRule::every, 10.0};
  options.closures = source;
  options.closures_radius = 0.1;
  options.closures_min_gap = 8.0;
  return options;
}

TEST(TrajectoryDataset, KeyframesOdometryAndTheRestAsFrames) {
  const Problem problem = derive_problem({shuttle(), {}, {}, {}, {}}, every_tenth({}));
  EXPECT_EQ(problem.keyframes.size(), 21u);
  EXPECT_EQ(problem.odometry.size(), 20u);
  EXPECT_EQ(problem.frames.size(), 180u);
  EXPECT_TRUE(problem.closures.empty());
  check(problem, "shuttle");
}

TEST(TrajectoryDataset, FramesOfTheRunReplaceTheRest) {
  TrajectoryInputs in{shuttle(), shuttle(), {}, {}, {}};
  in.frames.pop_back();
  EXPECT_EQ(derive_problem(in, every_tenth({})).frames.size(), 180u);
  TrajectoryOptions all;
  EXPECT_EQ(derive_problem(in, all).frames.size(), 0u);
}

TEST(TrajectoryDataset, ClosuresOfTheReferenceAreNoisyAndSeeded) {
  const TrajectoryInputs in{shuttle(), {}, shuttle(), {}, {}};
  TrajectoryOptions options = every_tenth(ClosureSource::reference);
  options.closures_noise = {1e-3, 1e-3};
  const Problem problem = derive_problem(in, options);
  ASSERT_FALSE(problem.closures.empty());
  for (const Edge& closure : problem.closures) {
    const Pose exact = problem.keyframes[closure.from].world_from_body.inverse() *
                       problem.keyframes[closure.to].world_from_body;
    EXPECT_FALSE(is_close(closure.from_from_to, exact, 1e-9, 1e-9));
    EXPECT_POSE_NEAR(closure.from_from_to, exact, 1e-2, 1e-2);
  }
  check(problem, "shuttle");
  const Problem again = derive_problem(in, options);
  options.seed = 2;
  const Problem other = derive_problem(in, options);
  EXPECT_EQ(problem.closures[0].from_from_to.translation,
            again.closures[0].from_from_to.translation);
  EXPECT_NE(problem.closures[0].from_from_to.translation,
            other.closures[0].from_from_to.translation);
}

TEST(TrajectoryDataset, ClosuresOfAnotherRunAreItsMeasurement) {
  TrajectoryInputs in{shuttle(), {}, {}, shuttle(), {}};
  const Pose elsewhere = exp_se3(twist({3.0, 2.0, 1.0}, {0.3, 0.2, 0.1}));
  for (auto& [stamp, pose] : in.other_run) pose = elsewhere * pose;
  const Problem problem = derive_problem(in, every_tenth(ClosureSource::estimate));
  ASSERT_FALSE(problem.closures.empty());
  for (const Edge& closure : problem.closures) {
    const Pose exact = problem.keyframes[closure.from].world_from_body.inverse() *
                       problem.keyframes[closure.to].world_from_body;
    EXPECT_POSE_NEAR(closure.from_from_to, exact, 1e-9, 1e-9);
  }
}

TEST(TrajectoryDataset, RefusesARunOfAnotherScale) {
  TrajectoryInputs in{shuttle(), {}, {}, shuttle(), {}};
  for (auto& [stamp, pose] : in.other_run) pose.translation *= 2.0;
  TrajectoryOptions options = every_tenth(ClosureSource::estimate);
  options.closures_file = "mono.txt";
  EXPECT_THAT(refusal_of([&] { derive_problem(in, options); }),
              HasSubstr("mono.txt: path length is 2 times that of the estimate"));
}

TEST(TrajectoryDataset, EndsOfListedClosuresAreKeyframes) {
  TrajectoryInputs in{shuttle(), {}, {}, {}, {}};
  in.closures = {{0.3, 10.3, {}, {0.1, 0.1}, 1}, {17.7, 2.3, {}, {0.1, 0.1}, 2}};
  const Problem problem = derive_problem(in, every_tenth(ClosureSource::file));
  check(problem, "shuttle");
  EXPECT_EQ(problem.keyframes.size(), 25u);
  ASSERT_EQ(problem.closures.size(), 2u);
  const auto stamp = [&](std::size_t i) { return problem.keyframes[i].stamp; };
  EXPECT_NEAR(stamp(problem.closures[0].from), 0.3, 1e-9);
  EXPECT_NEAR(stamp(problem.closures[0].to), 10.3, 1e-9);
  EXPECT_NEAR(stamp(problem.closures[1].from), 2.3, 1e-9);
  EXPECT_NEAR(stamp(problem.closures[1].to), 17.7, 1e-9);
}

std::string walk() {
  std::string text;
  for (int i = 0; i <= 12; ++i) {
    text += std::to_string(i) + " " + std::to_string(std::abs(i - 6)) + " 0 0 0 0 0 1\n";
  }
  return text;
}

Sequence load(const std::filesystem::path& folder, const Params& given) {
  return load_dataset("trajectory", given, {{folder}});
}

TEST(TrajectoryDataset, LoadsFilesAndTellsWhereAllCameFrom) {
  const TemporaryFolder folder;
  folder.file("room/est.txt", walk());
  folder.file("room/gt.txt", walk());
  const Sequence sequence = load(folder.path(),
                                 {{"estimate", "room/est.txt"},
                                  {"reference", "room/gt.txt"},
                                  {"closures.source", "reference"},
                                  {"closures.radius", 0.5},
                                  {"sensor", "RGB-D"},
                                  {"licence", "CC BY 4.0"}});
  EXPECT_EQ(sequence.name, "room_est");
  EXPECT_EQ(sequence.problem.keyframes.size(), 13u);
  EXPECT_EQ(sequence.reference.size(), 13u);
  EXPECT_EQ(sequence.problem.closures.size(), 4u);  // 12-0 11-1 10-2 9-3: at least 5 s apart
  EXPECT_TRUE(sequence.provenance.oracle_closures);
  EXPECT_THAT(sequence.provenance.closures, HasSubstr("reference with noise 0.02 m"));
  EXPECT_EQ(sequence.provenance.sensor, "RGB-D");
  EXPECT_EQ(sequence.provenance.licence, "CC BY 4.0");
  EXPECT_EQ(sequence.provenance.inputs.size(), 2u);
}

TEST(TrajectoryDataset, OnlyClosuresOfTheReferenceAreOracles) {
  const TemporaryFolder folder;
  folder.file("est.txt", walk());
  folder.file("loops.txt", "0 12 0 0 0 0 0 0 1\n");
  const Params given = {{"estimate", "est.txt"}, {"name", "x"}, {"closures.file", "loops.txt"}};
  Params of_file = given;
  of_file["closures.source"] = "file";
  const Sequence sequence = load(folder.path(), of_file);
  EXPECT_EQ(sequence.name, "x");
  EXPECT_FALSE(sequence.provenance.oracle_closures);
  EXPECT_EQ(sequence.provenance.closures, "file: loops.txt (1)");
  EXPECT_EQ(sequence.problem.closures.size(), 1u);
  const Sequence without = load(folder.path(), given);
  EXPECT_EQ(without.provenance.closures, "none");
  EXPECT_TRUE(without.reference.empty());
}

TEST(TrajectoryDataset, RefusesWhatDoesNotFitTogether) {
  const TemporaryFolder folder;
  folder.file("est.txt", walk());
  const auto refusal = [&](const Params& given) {
    return refusal_of([&] { load(folder.path(), given); });
  };
  EXPECT_THAT(refusal({}), HasSubstr("estimate: is empty, expected a trajectory file"));
  EXPECT_THAT(refusal({{"estimate", "est.txt"}, {"closures.source", "file"}}),
              HasSubstr("closures.file: is empty, expected a file for closures.source = file"));
  EXPECT_THAT(refusal({{"estimate", "est.txt"}, {"closures.source", "reference"}}),
              HasSubstr("reference: is empty, expected a file for closures.source = reference"));
  EXPECT_THAT(refusal({{"estimate", "est.txt"}, {"keyframes.rule", "some"}}),
              HasSubstr("all | every | seconds | metres | count"));
  EXPECT_THAT(refusal({{"estimate", "est.txt"}, {"closures.sigma_t", 0.0}}),
              HasSubstr("closures.sigma_t"));
}

TEST(TrajectoryDataset, APeriodIsForPosesWithoutStamps) {
  const TemporaryFolder folder;
  folder.file("kitti.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 1 0 1 0 0 0 0 1 0\n");
  const Sequence sequence = load(folder.path(), {{"estimate", "kitti.txt"}, {"period", 4.0}});
  EXPECT_EQ(sequence.problem.keyframes.back().stamp, 4.0);
}

}  // namespace
}  // namespace loopbench::trajectory_dataset_test

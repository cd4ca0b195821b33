// Measured positions from files, and simulated ones.
#include "datasets/derive/anchors.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "datasets/simulated/simulated.hpp"
#include "tests/datasets/random_poses.hpp"
#include "tests/support/refusal_of.hpp"
#include "tests/support/temporary_folder.hpp"

namespace loopbench::anchor_file_test {
namespace {

using testing::HasSubstr;

std::string refusal(const std::string& content) {
  const TemporaryFolder folder;
  const auto file = folder.file("points.txt", content);
  return refusal_of([&] { read_anchor_file(file, 0.5); });
}

TEST(AnchorFile, SigmaAndCovarianceAreColumns) {
  const TemporaryFolder folder;
  const auto plain = read_anchor_file(folder.file("a.txt", "# points\n1.5 1 2 3\n"), 0.5);
  ASSERT_EQ(plain.positions.size(), 1u);
  EXPECT_EQ(plain.positions[0].stamp, 1.5);
  EXPECT_EQ(plain.positions[0].position, Vector3(1.0, 2.0, 3.0));
  EXPECT_EQ(plain.positions[0].covariance, Matrix3(0.25 * Matrix3::Identity()));
  const auto sigma = read_anchor_file(folder.file("b.txt", "1 1 2 3 2\n2 1 2 3 3\n"), 0.5);
  EXPECT_EQ(sigma.positions[1].covariance, Matrix3(9.0 * Matrix3::Identity()));
  const auto full = read_anchor_file(folder.file("c.txt", "1 1 2 3 4 1 0 5 2 6\n"), 0.5);
  Matrix3 expected;
  expected << 4, 1, 0, 1, 5, 2, 0, 2, 6;
  EXPECT_EQ(full.positions[0].covariance, expected);
  const auto pose = read_anchor_file(folder.file("d.txt", "1 1 2 3 0 0 0 1\n"), 2.0);
  EXPECT_EQ(pose.positions[0].covariance, Matrix3(4.0 * Matrix3::Identity()));
}

TEST(AnchorFile, RefusalsNameFileAndLine) {
  EXPECT_THAT(refusal("1 1 2 3 0.1\n2 1 2 3\n"), HasSubstr("points.txt:2: has 4 columns"));
  EXPECT_THAT(refusal("1 1 2 3 0\n"), HasSubstr("points.txt:1: found sigma 0"));
  EXPECT_THAT(refusal("1 1 2 3 1\n1 1 2 3 1\n"), HasSubstr("points.txt:2: stamp 1"));
  EXPECT_THAT(refusal("1 1 2 3 1 2 0 1 0 1\n"), HasSubstr("points.txt:1: covariance is not"));
}

// The position at 1.25 s belongs to the point 0.25 m ahead of the keyframe at 1 s.
TEST(AnchorFile, PositionsBetweenKeyframesHaveALever) {
  Trajectory poses = on_a_line({0, 1, 2, 9});
  poses.back().stamp = 9.0;
  std::vector<StampedPosition> positions(4);
  positions[0].stamp = -1.0;
  positions[1].stamp = 1.25;
  positions[2].stamp = 2.0;
  positions[3].stamp = 5.0;  // in a gap of 7 s
  std::size_t skipped = 0;
  const auto anchors = as_anchors(positions, poses, poses, {2.0, 0.02}, skipped);
  EXPECT_EQ(skipped, 2u);
  ASSERT_EQ(anchors.size(), 2u);
  EXPECT_EQ(anchors[0].keyframe, 1u);
  EXPECT_NEAR(anchors[0].point_in_body.norm(), 0.25, 1e-12);
  EXPECT_EQ(anchors[1].keyframe, 2u);
  EXPECT_EQ(anchors[1].point_in_body.norm(), 0.0);
}

TEST(SimulatedAnchors, AreDifferentKeyframesWithTheStatedNoise) {
  SimulatedOptions options;
  options.anchors = {60, 0.1};
  options.keyframes = 200;
  const Sequence sequence = load_simulated(options);
  const std::vector<Anchor>& anchors = sequence.problem.anchors;
  ASSERT_EQ(anchors.size(), 60u);
  check(anchors, sequence.problem.keyframes.size(), "simulated");
  double sum = 0.0;
  for (std::size_t i = 0; i < anchors.size(); ++i) {
    if (i > 0) EXPECT_GT(anchors[i].keyframe, anchors[i - 1].keyframe);
    const double stamp = sequence.problem.keyframes[anchors[i].keyframe].stamp;
    const auto& truth = *std::ranges::find(sequence.reference, stamp, &StampedPose::stamp);
    sum += anchor_error(anchors[i], truth.world_from_body).squaredNorm();
  }
  EXPECT_NEAR(std::sqrt(sum / 180.0), 0.1, 0.02);  // 180 coordinates: deviation 0.005
  options.anchors.count = 201;
  EXPECT_THROW(load_simulated(options), OptionError);
}

TEST(SimulatedAnchors, DoNotChangeOtherNoise) {
  SimulatedOptions options;
  options.stream = "shared";
  const Problem without = load_simulated(options).problem;
  options.anchors.count = 5;
  const Problem with = load_simulated(options).problem;
  for (std::size_t i = 0; i < without.keyframes.size(); ++i) {
    EXPECT_EQ(without.keyframes[i].world_from_body.translation,
              with.keyframes[i].world_from_body.translation);
  }
}

}  // namespace
}  // namespace loopbench::anchor_file_test

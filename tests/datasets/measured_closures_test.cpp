#include <gtest/gtest.h>

#include <cmath>

#include "datasets/core/interpolate.hpp"
#include "datasets/derive/closures.hpp"
#include "tests/datasets/random_poses.hpp"

namespace loopbench::measured_closures_test {
namespace {

TEST(PosesAt, InterpolateOverShortGapsOnly) {
  Trajectory run = on_a_line({0.0, 1.0, 2.0}, 0.1);
  run.push_back({1.0, {Rotation::Identity(), {9.0, 0.0, 0.0}}});
  const auto poses = poses_at(run, {0.05, 0.2, 0.21, 0.5, 0.99, 1.01, 1.5, -0.01, -1.0}, {});
  ASSERT_EQ(poses.size(), 9u);
  EXPECT_NEAR(poses[0]->translation.x(), 0.5, 1e-12);
  EXPECT_NEAR(poses[1]->translation.x(), 2.0, 1e-12);
  EXPECT_NEAR(poses[2]->translation.x(), 2.0, 1e-12);  // nearest, 0.01 s away
  EXPECT_FALSE(poses[3]);                              // in a gap
  EXPECT_EQ(poses[4]->translation.x(), 9.0);
  EXPECT_EQ(poses[5]->translation.x(), 9.0);
  EXPECT_FALSE(poses[6]);
  EXPECT_EQ(poses[7]->translation.x(), 0.0);
  EXPECT_FALSE(poses[8]);
  EXPECT_FALSE(poses_at({}, {0.0}, {})[0]);
}

TEST(PosesAt, NearestPrefersTheEarlierOfEquals) {
  const Trajectory run = on_a_line({0.0, 1.0});
  EXPECT_EQ(nearest_pose(run, 0.5, 0.5), 0u);
  EXPECT_EQ(nearest_pose(run, 0.6, 0.5), 1u);
  EXPECT_EQ(nearest_pose(run, 2.0, 0.5), std::nullopt);
}

/// Two rounds on a circle with radius 2 m in 20 s, looking forward.
Trajectory two_rounds(std::size_t size) {
  Trajectory out;
  for (std::size_t i = 0; i < size; ++i) {
    const double time = 20.0 * static_cast<double>(i) / static_cast<double>(size - 1);
    const double angle = 4.0 * M_PI * time / 20.0;
    out.push_back(
        {time, {exp_so3({0.0, 0.0, angle}), {2.0 * std::cos(angle), 2.0 * std::sin(angle), 0.0}}});
  }
  return out;
}

TEST(MeasuredClosures, AreTheRunsOwnRelativePoses) {
  const Trajectory run = two_rounds(401);
  Trajectory keyframes;
  for (std::size_t i = 0; i < run.size(); i += 8) {  // every 0.4 s, with drift
    const Pose drift = exp_se3(twist({0.0, 0.0, 0.01 * static_cast<double>(i)}, Vector3::Zero()));
    keyframes.push_back({run[i].stamp, drift * run[i].world_from_body});
  }
  const auto closures = measure_closures_in_run(keyframes, run, {0.3, 0.3, 5.0}, 0, {}, {});
  ASSERT_EQ(closures.size(), 26u);  // all keyframes of the second round: 10 s to 20 s
  for (const Edge& closure : closures) {
    EXPECT_EQ(closure.to - closure.from, 25u);
    EXPECT_TRUE(is_close(closure.from_from_to, {}, 1e-9, 1e-9));
    EXPECT_NEAR(closure.information(0, 0), 1.0 / (0.02 * 0.02), 1e-9);
    EXPECT_NEAR(closure.information(3, 3), 1.0 / (0.01 * 0.01), 1e-9);
  }
  EXPECT_EQ(measure_closures_in_run(keyframes, run, {0.3, 0.3, 5.0}, 4, {}, {}).size(), 4u);
}

TEST(MeasuredClosures, SkipKeyframesTheRunDoesNotKnow) {
  const Trajectory keyframes = two_rounds(51);
  Trajectory run = two_rounds(401);
  run.resize(301);  // no poses after 15 s
  const auto closures = measure_closures_in_run(keyframes, run, {0.3, 0.3, 5.0}, 0, {}, {});
  ASSERT_FALSE(closures.empty());
  EXPECT_LE(keyframes[closures.back().to].stamp, 15.02);
}

TEST(MeasuredClosures, NoiseHasTheStatedSizeAndSeed) {
  const std::vector<Edge> exact(20000, Edge{0, 1, {}, Matrix6::Identity()});
  const auto noisy = with_noise(exact, {0.05, 0.02}, {7});
  Twist variance = Twist::Zero();
  for (const Edge& edge : noisy) {
    variance += log_se3(edge.from_from_to).cwiseAbs2() / static_cast<double>(noisy.size());
  }
  // Relative standard error of a variance: sqrt(2 / 20000) = 0.01.
  for (int i = 0; i < 6; ++i)
    EXPECT_NEAR(std::sqrt(variance[i]) / (i < 3 ? 0.05 : 0.02), 1.0, 0.02);
  const auto again = with_noise(exact, {0.05, 0.02}, {7});
  const auto other = with_noise(exact, {0.05, 0.02}, {8});
  EXPECT_EQ(noisy[99].from_from_to.translation, again[99].from_from_to.translation);
  EXPECT_NE(noisy[99].from_from_to.translation, other[99].from_from_to.translation);
}

TEST(MeasuredClosures, PathRatioShowsAnotherScale) {
  const Trajectory keyframes = two_rounds(51);
  Trajectory run = two_rounds(401);
  for (auto& [stamp, pose] : run) pose.translation *= 3.0;
  EXPECT_NEAR(path_length_ratio(keyframes, run, {}), 3.0, 1e-9);
  EXPECT_EQ(path_length_ratio(keyframes, {}, {}), 1.0);
}

TEST(MeasuredClosures, OfARunWithItsOwnUnitAreOfSim3) {
  // The run moves 3 m per step; the estimate 1 at first, and 0.5 from keyframe 30.
  Trajectory keyframes, run;
  double x = 0.0;
  for (int i = 0; i < 60; ++i) {
    keyframes.push_back({double(i), {Rotation::Identity(), Vector3(x, 0, 0)}});
    run.push_back({double(i), {Rotation::Identity(), Vector3(3.0 * i, 0, 0)}});
    x += i < 30 ? 1.0 : 0.5;
  }
  const Edge measured{10, 50, {Rotation::Identity(), Vector3(120, 0, 0)}, Matrix6::Identity()};
  const auto edges = with_local_scale({measured}, keyframes, run, {});
  EXPECT_NEAR(edges[0].scale, 6.0 / 3.0, 1e-12);
  EXPECT_NEAR(
      edges[0].from_from_to.translation.x(), 40.0, 1e-12);  // 120 m in the run, 3 m per unit
  Trajectory still = keyframes;
  for (auto& [stamp, pose] : still) pose = Pose{Rotation::Identity(), Vector3::Zero()};
  EXPECT_THROW(with_local_scale({measured}, still, run, {}), InputError);
}

}  // namespace
}  // namespace loopbench::measured_closures_test

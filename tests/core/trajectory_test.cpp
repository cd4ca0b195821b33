#include "datasets/core/trajectory.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "tests/support/refusal_of.hpp"

namespace loopbench::trajectory_test {
namespace {

Trajectory corner() {
  Trajectory out(3);
  out[0] = {0.0, {Rotation::Identity(), Vector3(0.0, 0.0, 0.0)}};
  out[1] = {0.5, {Rotation::Identity(), Vector3(3.0, 0.0, 0.0)}};
  out[2] = {2.0, {Rotation::Identity(), Vector3(3.0, 4.0, 0.0)}};
  return out;
}

std::string refusal(const std::function<void(Trajectory&)>& spoil) {
  Trajectory poses = corner();
  spoil(poses);
  return refusal_of<InputError>([&] { check(poses, "walk"); });
}

TEST(Trajectory, LengthAndStamps) {
  EXPECT_EQ(path_length(corner()), 7.0);
  EXPECT_EQ(path_length({}), 0.0);
  EXPECT_EQ(stamps(corner()), (std::vector<double>{0.0, 0.5, 2.0}));
}

TEST(Trajectory, CheckAcceptsGoodOnesAndEmptyOnes) {
  EXPECT_EQ(refusal([](Trajectory&) {}), "");
  EXPECT_EQ(refusal([](Trajectory& poses) { poses.clear(); }), "");
}

TEST(Trajectory, CheckNamesThePoseAndTheRule) {
  EXPECT_EQ(refusal([](Trajectory& poses) { poses[1].stamp = 0.0; }),
            "walk: pose 1: stamp does not increase");
  EXPECT_EQ(refusal([](Trajectory& poses) { poses[2].stamp = 0.4; }),
            "walk: pose 2: stamp does not increase");
  EXPECT_EQ(refusal([](Trajectory& poses) { poses[0].stamp = std::nan(""); }),
            "walk: pose 0: is not finite");
  EXPECT_EQ(refusal([](Trajectory& poses) {
              poses[1].world_from_body.translation.y() = std::numeric_limits<double>::infinity();
            }),
            "walk: pose 1: is not finite");
  EXPECT_EQ(refusal([](Trajectory& poses) { poses[2].world_from_body.rotation.w() = 1.0001; }),
            "walk: pose 2: quaternion is not unit");
}

}  // namespace
}  // namespace loopbench::trajectory_test

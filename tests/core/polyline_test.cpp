#include "datasets/core/polyline.hpp"

#include <gtest/gtest.h>

#include "tests/core/numeric.hpp"
#include "tests/support/tolerance.hpp"

namespace loopbench::polyline_test {
namespace {

Trajectory three_poses() {
  const std::vector<Pose> poses = general_poses();
  return {{1.0, poses[0]}, {2.0, poses[1]}, {4.0, poses[2]}};
}

TEST(Polyline, ReturnsItsNodesToTheBit) {
  const Trajectory nodes = three_poses();
  const Polyline line(nodes);
  EXPECT_EQ(line.start(), 1.0);
  EXPECT_EQ(line.end(), 4.0);
  const Trajectory back = line.sample(stamps(nodes));
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    EXPECT_EQ(back[i].stamp, nodes[i].stamp);
    EXPECT_EQ(back[i].world_from_body.translation, nodes[i].world_from_body.translation);
    EXPECT_EQ(back[i].world_from_body.rotation.coeffs(),
              nodes[i].world_from_body.rotation.coeffs());
  }
}

TEST(Polyline, InterpolatesByTime) {
  const Trajectory nodes = three_poses();
  const Pose wanted = interpolate(nodes[1].world_from_body, nodes[2].world_from_body, 0.25);
  EXPECT_POSE_NEAR(Polyline(nodes).at(2.5), wanted, 1e-14, 1e-14);
}

TEST(Polyline, TakesTimesInAnyOrder) {
  const Polyline line(three_poses());
  const Trajectory mixed = line.sample(std::vector<double>{3.9, 1.1, 2.0, 1.0, 4.0});
  for (const auto& [stamp, pose] : mixed) EXPECT_TRUE(is_close(pose, line.at(stamp), 0.0, 1e-15));
}

TEST(Polyline, OnePoseIsACurveOfOneInstant) {
  const Polyline line({{2.0, general_poses()[0]}});
  EXPECT_EQ(line.at(2.0).translation, general_poses()[0].translation);
  EXPECT_THROW(line.at(2.1), std::out_of_range);
}

TEST(Polyline, RefusesNoPoseAndTimesOutside) {
  EXPECT_THROW(Polyline({}), std::invalid_argument);
  EXPECT_THROW(Polyline(three_poses()).at(0.9), std::out_of_range);
}

}  // namespace
}  // namespace loopbench::polyline_test

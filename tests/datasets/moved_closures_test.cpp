/// Closures at stamps between poses.
#include <gtest/gtest.h>

#include "datasets/core/interpolate.hpp"
#include "datasets/derive/closures.hpp"
#include "datasets/derive/odometry.hpp"
#include "tests/support/tolerance.hpp"

namespace loopbench::moved_closures_test {
namespace {

TEST(ClosureFile, EndsBetweenPosesAreMovedByTheTrackedMotion) {
  // A body that moves and turns; keyframes each second, frames each tenth of it.
  const auto at = [](double t) {
    return Pose{exp_so3({0.0, 0.1 * t, 0.3 * t}), {t, 0.5 * t * t, 0.1 * t}};
  };
  Trajectory keyframes, frames;
  for (int i = 0; i <= 50; ++i) frames.push_back({0.1 * i, at(0.1 * i)});
  for (int i = 0; i <= 5; ++i) keyframes.push_back({static_cast<double>(i), at(i)});
  std::vector<StampedClosure> closures = {{0.3, 4.4, at(0.3).inverse() * at(4.4), {0.1, 0.02}, 1},
                                          {1.0, 3.0, at(1.0).inverse() * at(3.0), {0.1, 0.02}, 2}};
  EXPECT_EQ(move_to_poses(closures, keyframes, frames, {}), 1u);
  const auto edges = as_edges(closures, keyframes, 0.02, "f");
  ASSERT_EQ(edges.size(), 2u);
  EXPECT_EQ(edges[1].from, 0u);
  EXPECT_EQ(edges[1].to, 4u);
  EXPECT_POSE_NEAR(edges[1].from_from_to, at(0.0).inverse() * at(4.0), 1e-9, 1e-9);
  EXPECT_EQ(edges[0].information, isotropic_information(0.1 * 0.1, 0.02 * 0.02));
  // An error at the measured end has the same cost at the moved one.
  const Twist error = twist({1e-6, 2e-6, -1e-6}, {3e-6, -1e-6, 2e-6});
  const Pose true_to = at(4.4) * exp_se3(error) * (at(4.0).inverse() * at(4.4)).inverse();
  const Twist seen = log_se3(edges[1].from_from_to.inverse() * (at(0.0).inverse() * true_to));
  EXPECT_NEAR(seen.dot(edges[1].information * seen) /
                  error.dot(isotropic_information(0.1 * 0.1, 0.02 * 0.02) * error),
              1.0,
              1e-5);
}

}  // namespace
}  // namespace loopbench::moved_closures_test

// Shared views: values by hand, and revisits by them.
#include "datasets/derive/view.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "datasets/derive/revisits.hpp"

namespace loopbench::view_test {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

View kinect() { return {57.0 * kDegree, 43.0 * kDegree, 0.8, 4.0}; }

/// A camera at `position` whose z axis points to the right of the world's by `yaw`.
Pose camera(const Vector3& position, double yaw) { return {exp_so3({0.0, yaw, 0.0}), position}; }

TEST(SharedView, OfTheSamePoseIsAllAndOfTheOtherDirectionNothing) {
  const SharedView view(kinect());
  EXPECT_EQ(view.share({}), 1.0);
  EXPECT_EQ(view.share(camera({0, 0, 0}, std::numbers::pi)), 0.0);
  EXPECT_EQ(view.share(camera({0, 0, 9}, 0.0)), 0.0);
}

// Rotated about the vertical axis by a part of the field of view, the rest of it is shared.
TEST(SharedView, FallsLinearlyWithTheRotation) {
  const SharedView view(kinect());
  for (const double part : {0.25, 0.5, 0.75}) {
    EXPECT_NEAR(view.share(camera({0, 0, 0}, part * 57.0 * kDegree)), 1.0 - part, 1e-9) << part;
  }
}

// A camera d behind another sees what is at most r - d from that: ((r - d)^3 - n^3) / (r^3 - n^3),
// of narrow views.
TEST(SharedView, FallsWithTheCubeOfTheRangeAlongTheAxis) {
  const SharedView view({4.0 * kDegree, 4.0 * kDegree, 0.8, 4.0});
  for (const double d : {0.3, 0.6, 1.2}) {
    const double expected =
        (std::pow(4.0 - d, 3) - std::pow(0.8, 3)) / (std::pow(4.0, 3) - std::pow(0.8, 3));
    EXPECT_NEAR(view.share(camera({0, 0, d}, 0.0)), expected, 0.17) << d;
  }
}

// Two balls of radius r whose centres are d apart share 1 - 3/4 (d / r) + 1/16 (d / r)^3.
TEST(SharedView, OfScannersIsThatOfTwoBalls) {
  const View scanner{
      2.0 * std::numbers::pi, std::numbers::pi, 0.0, 30.0, 0.5, View::Axes::x_forward};
  const SharedView view(scanner);
  for (const double part : {0.2, 0.5, 0.8}) {
    const double expected = 1.0 - 0.75 * part + std::pow(part, 3) / 16.0;
    EXPECT_NEAR(view.share({exp_so3({0, 0, 2.0}), {30.0 * part, 0, 0}}), expected, 0.05) << part;
  }
}

TEST(SharedView, OfVehiclesLooksAlongX) {
  View view = kinect();
  view.axes = View::Axes::x_forward;
  EXPECT_NEAR(
      SharedView(view).share({exp_so3({0, 0, 0.5 * 57.0 * kDegree}), Vector3::Zero()}), 0.5, 1e-9);
}

/// The camera looks along z, goes away, and comes back 0.9 m beside its start.
Trajectory there_and_beside(double yaw) {
  Trajectory out;
  for (int i = 0; i < 10; ++i) out.push_back({double(i), camera({0, 0, -2.0 * i}, 0.0)});
  out.push_back({20.0, camera({0.9, 0, 0}, yaw)});
  return out;
}

TEST(RevisitsByView, AreThoseThatShareHalfOfIt) {
  const RevisitRule rule{.min_gap = 5.0, .view = kinect()};
  EXPECT_EQ(find_revisits(there_and_beside(0.0), rule), (std::vector<Revisit>{{0, 10}}));
  // Towards what was seen before, more is shared than away from it.
  EXPECT_EQ(find_revisits(there_and_beside(-0.3), rule).size(), 1u);
  EXPECT_TRUE(find_revisits(there_and_beside(0.3), rule).empty());
  EXPECT_TRUE(find_revisits(there_and_beside(0.0), {0.5, 0.5, 5.0}).empty());
}

TEST(RevisitsByView, TakeTheNearestOfAllEarlierPosesInReach) {
  // More poses in one place than the rule of distances compares.
  Trajectory poses;
  for (int i = 0; i < 500; ++i) poses.push_back({0.1 * i, camera({0.0, 0, 0.001 * i}, 3.0)});
  poses.front().world_from_body = camera({0.1, 0, 0}, 0.0);
  poses.push_back({100.0, camera({0, 0, 0}, 0.0)});
  const RevisitRule rule{.min_gap = 60.0, .view = kinect()};
  EXPECT_EQ(find_revisits(poses, rule), (std::vector<Revisit>{{0, 500}}));
}

}  // namespace
}  // namespace loopbench::view_test

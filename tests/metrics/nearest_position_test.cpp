#include "metrics/pairing/nearest_position.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "metrics/alignment/alignment.hpp"
#include "tests/metrics/support.hpp"

namespace loopbench::nearest_position_test {
namespace {

using namespace test;
using testing::ElementsAre;

Pose at(double x, double y) { return {Rotation::Identity(), {x, y, 0}}; }

Trajectory straight() {
  Trajectory out;
  for (int i = 0; i <= 10; ++i) out.push_back({0.1 * i, at(i, 0)});
  return out;
}

std::vector<double> coordinates(const Trajectory& poses, int axis) {
  std::vector<double> out;
  for (const auto& [stamp, pose] : poses) out.push_back(pose.translation[axis]);
  return out;
}

TEST(NearestPosition, IsOnThePathBetweenPoses) {
  const Trajectory run{{100, at(0.25, 0.3)}, {101, at(5.5, -0.3)}, {102, at(9, 0.7)}};
  const RepeatedRoute route = on_repeated_route(straight(), run, 0.5, Align::none);
  EXPECT_THAT(coordinates(route.reference, 0), ElementsAre(0.25, 5.5));
  EXPECT_THAT(coordinates(route.reference, 1), ElementsAre(0.0, 0.0));
  EXPECT_THAT(stamps(route.reference), ElementsAre(100.0, 101.0));
  // The run is 0.39 m away from x = 0, 0.40 m from x = 8, and 0.67 m from x = 9.
  EXPECT_EQ(route.visited, 9.0 / 11.0);
}

TEST(NearestPosition, FollowsTheDirectionOfTravel) {
  // Out along y = 0 and back along y = 0.2.
  Trajectory there_and_back = straight();
  for (int i = 10; i >= 0; --i) there_and_back.push_back({3 - 0.1 * i, at(i, 0.2)});
  Trajectory out, back;
  for (int i = 3; i <= 7; ++i) {
    out.push_back({0.1 * i, at(i, 0.2)});
    back.push_back({0.1 * i, at(10 - i, 0.0)});
  }
  const auto lanes = [&](const Trajectory& run) {
    return coordinates(on_repeated_route(there_and_back, run, 1.0, Align::none).reference, 1);
  };
  EXPECT_THAT(lanes(out), ElementsAre(0, 0, 0, 0, 0));
  EXPECT_THAT(lanes(back), ElementsAre(0.2, 0.2, 0.2, 0.2, 0.2));
}

TEST(NearestPosition, AlignsByIteratedClosestPoints) {
  Trajectory rectangle;
  for (int i = 0; i < 60; ++i) {
    const double x = i < 20 ? i : i < 30 ? 20 : i < 50 ? 50 - i : 0;
    const double y = i < 20 ? 0 : i < 30 ? i - 20 : i < 50 ? 10 : 60 - i;
    rectangle.push_back({0.1 * i, at(x, y)});
  }
  const Pose offset{exp_so3({0.01, -0.02, 0.03}), {0.3, -0.2, 0.1}};
  const Trajectory run = moved_by(offset, 1.0, rectangle);
  const RepeatedRoute route = on_repeated_route(rectangle, run, 3.0, Align::se3);
  ASSERT_EQ(route.reference.size(), run.size());
  EXPECT_EQ(route.visited, 1.0);
  const Alignment fit = align(route.reference, run, Align::se3);
  EXPECT_NEAR(
      (fit.reference_from_estimate.translation - offset.inverse().translation).norm(), 0.0, 1e-3);
}

TEST(NearestPosition, RejectsFilesOfOtherFrames) {
  const Trajectory far{{0, at(0, 100)}, {1, at(1, 100)}};
  EXPECT_THAT(
      why<std::runtime_error>([&] { on_repeated_route(straight(), far, 2.0, Align::none); }),
      testing::HasSubstr("within 2.0 m of the reference's path in the same direction"));
}

}  // namespace
}  // namespace loopbench::nearest_position_test

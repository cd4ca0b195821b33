// Interpolation of poses, polylines, and the interval of a time.
#include "datasets/core/interpolate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "datasets/core/knot_span.hpp"
#include "datasets/core/polyline.hpp"
#include "tests/core/numeric.hpp"
#include "tests/support/tolerance.hpp"

namespace loopbench::interpolate_test {
namespace {

constexpr double kShares[] = {0.0, 1e-9, 0.25, 0.5, 0.9, 1.0};

/// Steps whose shortest arc is unique.
std::vector<Twist> steps() {
  std::vector<Twist> out;
  for (const Twist& xi : awkward_twists()) {
    if (xi.tail<3>().norm() < std::numbers::pi - 1e-9) out.push_back(xi);
  }
  return out;
}

TEST(Interpolate, EndsAreTheGivenPoses) {
  for (const Pose& a : general_poses()) {
    for (const Twist& xi : awkward_twists()) {
      const Pose b = a * exp_se3(xi);
      EXPECT_NEAR(distance(interpolate(a, b, 0.0), a), 0.0, 2e-15);
      EXPECT_NEAR(distance(interpolate(a, b, 1.0), b), 0.0, 1e-13) << xi.transpose();
    }
  }
}

TEST(Interpolate, BackwardsIsForwardsFromTheOtherEnd) {
  for (const Pose& a : general_poses()) {
    for (const Twist& xi : steps()) {
      const Pose b = a * exp_se3(xi);
      for (const double u : kShares) {
        // Near pi the arc's direction is only known to rounding / (pi - angle).
        const double room = std::numbers::pi - xi.tail<3>().norm();
        EXPECT_NEAR(
            distance(interpolate(a, b, u), interpolate(b, a, 1.0 - u)), 0.0, 1e-12 + 1e-14 / room);
      }
    }
  }
}

TEST(Interpolate, DoesNotCareWhereTheWorldIs) {
  for (const Pose& elsewhere : general_poses()) {
    const Pose a = general_poses()[1];
    for (const Twist& xi : steps()) {
      const Pose b = a * exp_se3(xi);
      const double room = std::numbers::pi - xi.tail<3>().norm();
      for (const double u : kShares) {
        EXPECT_NEAR(distance(elsewhere * interpolate(a, b, u),
                             interpolate(elsewhere * a, elsewhere * b, u)),
                    0.0,
                    1e-12 + 1e-13 / room);
      }
    }
  }
}

TEST(Interpolate, IgnoresTheSignOfAQuaternion) {
  const Pose a = general_poses()[0];
  const Pose b = a * exp_se3((Twist() << 1.0, 2.0, 3.0, 0.5, -1.0, 2.0).finished());
  Pose minus = b;
  minus.rotation.coeffs() *= -1.0;
  EXPECT_NEAR(distance(interpolate(a, b, 0.3), interpolate(a, minus, 0.3)), 0.0, 1e-14);
}

TEST(Interpolate, KeepsToTheChord) {
  // A quarter turn to the left on a circle of radius 2 m about (0, 2).
  const Pose a;
  const Pose b{exp_so3(Vector3(0.0, 0.0, 0.5 * std::numbers::pi)), Vector3(2.0, 2.0, 0.0)};
  const Pose half = interpolate(a, b, 0.5);
  EXPECT_NEAR((half.translation - Vector3(1.0, 1.0, 0.0)).norm(), 0.0, 1e-15);
  const Rotation eighth = exp_so3(Vector3(0.0, 0.0, 0.25 * std::numbers::pi));
  EXPECT_NEAR(angle_between(half.rotation, eighth), 0.0, 1e-15);
}

TEST(Interpolate, TurnsAtConstantRate) {
  const Rotation a = exp_so3(Vector3(0.2, 0.3, -1.0));
  for (const Vector3& phi : awkward_rotations()) {
    const Rotation b = a * exp_so3(phi);
    for (const double u : kShares) {
      EXPECT_NEAR(angle_between(a, slerp(a, b, u)), u * phi.norm(), 1e-14);
    }
  }
}

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

TEST(Polyline, OnePoseIsACurveOfOneInstant) {
  const Polyline line({{2.0, general_poses()[0]}});
  EXPECT_EQ(line.at(2.0).translation, general_poses()[0].translation);
  EXPECT_THROW(line.at(2.1), std::out_of_range);
}

TEST(Polyline, RefusesNoPoseAndTimesOutside) {
  EXPECT_THROW(Polyline({}), std::invalid_argument);
  EXPECT_THROW(Polyline(three_poses()).at(0.9), std::out_of_range);
}

const std::vector<double> kStamps = {1.0, 2.0, 4.0, 4.5, 10.0};

TEST(KnotSpan, FindsTheIntervalByHand) {
  KnotSpan span(kStamps);
  EXPECT_EQ(span.find(1.0), 0U);
  EXPECT_EQ(span.find(1.999), 0U);
  EXPECT_EQ(span.find(2.0), 1U);
  EXPECT_EQ(span.find(4.2), 2U);
  EXPECT_EQ(span.find(4.5), 3U);
  EXPECT_EQ(span.find(10.0), 3U) << "the last stamp belongs to the last interval";
}

TEST(KnotSpan, AnswerDoesNotDependOnWhatWasAskedBefore) {
  std::mt19937_64 random(3);
  KnotSpan used(kStamps);
  for (int k = 0; k < 2000; ++k) {
    const double time = 1.0 + static_cast<double>(random() % 37) * 0.25;
    EXPECT_EQ(used.find(time), KnotSpan(kStamps).find(time)) << time;
  }
}

TEST(KnotSpan, OneStampIsOneAnswer) {
  const std::vector<double> one = {3.0};
  EXPECT_EQ(KnotSpan(one).find(3.0), 0U);
  EXPECT_THROW(KnotSpan(one).find(3.1), std::out_of_range);
}

TEST(KnotSpan, RefusesTimesOutsideAndNan) {
  KnotSpan span(kStamps);
  EXPECT_THROW(span.find(0.999), std::out_of_range);
  EXPECT_THROW(span.find(10.001), std::out_of_range);
  EXPECT_THROW(span.find(std::nan("")), std::out_of_range);
  const std::vector<double> none;
  EXPECT_THROW(KnotSpan(none).find(0.0), std::out_of_range);
}

}  // namespace
}  // namespace loopbench::interpolate_test

#include "datasets/core/interpolate.hpp"

#include <gtest/gtest.h>

#include "tests/core/numeric.hpp"

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

}  // namespace
}  // namespace loopbench::interpolate_test

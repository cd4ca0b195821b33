#include "datasets/core/se3.hpp"

#include <gtest/gtest.h>

#include "tests/core/numeric.hpp"
#include "tests/support/tolerance.hpp"

namespace loopbench::se3_test {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(Se3, LogUndoesExp) {
  for (const Twist& xi : awkward_twists()) {
    if (xi.tail<3>().norm() > kPi - 1e-15) continue;  // either sign is right there
    EXPECT_NEAR((log_se3(exp_se3(xi)) - xi).norm(), 0.0, 1e-14 * (1.0 + xi.norm()))
        << xi.transpose();
  }
}

TEST(Se3, ExpUndoesLog) {
  for (const Twist& xi : awkward_twists()) {
    const Pose pose = exp_se3(xi);
    EXPECT_NEAR(distance(exp_se3(log_se3(pose)), pose), 0.0, 1e-14 * (1.0 + xi.norm()))
        << xi.transpose();
  }
}

TEST(Se3, ExpAgreesWithTheMatrixPowerSeries) {
  for (const Twist& xi : awkward_twists()) {
    Eigen::Matrix4d generator = Eigen::Matrix4d::Zero();
    generator.topLeftCorner<3, 3>() = hat(xi.tail<3>());
    generator.topRightCorner<3, 1>() = xi.head<3>();
    Eigen::Matrix4d sum = Eigen::Matrix4d::Identity(), term = sum;
    for (int k = 1; k < 40; ++k) sum += term = (term * generator / k).eval();
    const Pose pose = exp_se3(xi);
    EXPECT_NEAR((pose.rotation.toRotationMatrix() - sum.topLeftCorner<3, 3>()).norm(), 0.0, 1e-14);
    EXPECT_NEAR(
        (pose.translation - sum.topRightCorner<3, 1>()).norm(), 0.0, 1e-14 * (1.0 + xi.norm()));
  }
}

TEST(Se3, GroupLawsHold) {
  const Vector3 point(0.3, -0.7, 2.0);
  for (const Pose& a : general_poses()) {
    EXPECT_NEAR(distance(a * a.inverse(), Pose{}), 0.0, 1e-13);
    EXPECT_NEAR(distance(a.inverse() * a, Pose{}), 0.0, 1e-13);
    for (const Pose& b : general_poses()) {
      EXPECT_NEAR(((a * b) * point - a * (b * point)).norm(), 0.0, 5e-13);
      EXPECT_NEAR(distance((a * b).inverse(), b.inverse() * a.inverse()), 0.0, 1e-12);
      for (const Pose& c : general_poses()) {
        EXPECT_NEAR(distance((a * b) * c, a * (b * c)), 0.0, 1e-12);
      }
    }
  }
}

TEST(Se3, AdjointCarriesATwistAcrossAPose) {
  for (const Pose& a : general_poses()) {
    for (const Twist& xi : awkward_twists()) {
      EXPECT_NEAR(
          distance(a * exp_se3(xi), exp_se3(adjoint(a) * xi) * a), 0.0, 1e-12 * (1.0 + xi.norm()));
    }
    for (const Pose& b : general_poses()) {
      EXPECT_NEAR((adjoint(a * b) - adjoint(a) * adjoint(b)).norm(), 0.0, 1e-11);
    }
    EXPECT_NEAR((adjoint(a) * adjoint(a.inverse()) - Matrix6::Identity()).norm(), 0.0, 1e-11);
  }
}

TEST(Se3, LeftJacobianIsTheDerivativeOfExp) {
  for (const Twist& xi : awkward_twists()) {
    const Pose back = exp_se3(xi).inverse();
    const double size = 1.0 + xi.norm();
    expect_jacobian(
        "left",
        left_jacobian_se3(xi),
        [&](const Twist& d) { return log_se3(exp_se3(xi + d) * back); },
        1e-9 * size);
    expect_jacobian(
        "right",
        right_jacobian_se3(xi),
        [&](const Twist& d) { return log_se3(back * exp_se3(xi + d)); },
        1e-9 * size);
  }
}

TEST(Se3, InverseLeftJacobianIsTheDerivativeOfLog) {
  for (const Twist& xi : awkward_twists()) {
    if (xi.tail<3>().norm() > kPi - 1e-4) continue;  // log jumps at pi
    const Pose pose = exp_se3(xi);
    const double size = 1.0 + xi.norm();
    expect_jacobian(
        "inverse left",
        inverse_left_jacobian_se3(xi),
        [&](const Twist& d) { return log_se3(exp_se3(d) * pose); },
        1e-9 * size);
    expect_jacobian(
        "inverse right",
        inverse_right_jacobian_se3(xi),
        [&](const Twist& d) { return log_se3(pose * exp_se3(d)); },
        1e-9 * size);
  }
}

TEST(Se3, JacobianTimesInverseIsIdentity) {
  for (const Twist& xi : awkward_twists()) {
    const Matrix6 left = left_jacobian_se3(xi) * inverse_left_jacobian_se3(xi);
    const Matrix6 right = inverse_right_jacobian_se3(xi) * right_jacobian_se3(xi);
    EXPECT_NEAR((left - Matrix6::Identity()).norm(), 0.0, 1e-14 * (1.0 + xi.norm()))
        << xi.transpose();
    EXPECT_NEAR((right - Matrix6::Identity()).norm(), 0.0, 1e-14 * (1.0 + xi.norm()))
        << xi.transpose();
  }
}

TEST(Se3, CouplingBlockDoesNotJumpWhereSeriesMeetClosedForms) {
  for (const double angle : {kSmallAngle, 0.05}) {
    for (const Vector3& axis : awkward_axes()) {
      const Vector3 rho(1.0, -2.0, 0.5);
      const Matrix3 below = coupling_block_se3(rho, angle * (1.0 - 1e-14) * axis);
      const Matrix3 above = coupling_block_se3(rho, angle * (1.0 + 1e-14) * axis);
      // angle - sin(angle) has lost eps / angle^2 = 1e-13 there, and stands beside angle |rho|.
      EXPECT_NEAR((below - above).norm(), 0.0, 2e-13) << angle << " about " << axis.transpose();
    }
  }
}

TEST(Se3, NormalizedAndCloseness) {
  Pose pose;
  pose.rotation.coeffs() *= 1.5;
  EXPECT_DOUBLE_EQ(normalized(pose).rotation.norm(), 1.0);
  const Pose off{exp_so3(Vector3(0.0, 0.0, 0.1)), Vector3(0.0, 0.2, 0.0)};
  EXPECT_POSE_NEAR(Pose{}, off, 0.21, 0.11);
  EXPECT_FALSE(is_close(Pose{}, off, 0.19, 0.11));
  EXPECT_FALSE(is_close(Pose{}, off, 0.21, 0.09));
  pose.translation.x() = std::nan("");
  EXPECT_FALSE(is_finite(pose));
}

}  // namespace
}  // namespace loopbench::se3_test

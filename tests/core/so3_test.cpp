#include "datasets/core/so3.hpp"

#include <gtest/gtest.h>

#include "tests/core/numeric.hpp"

namespace loopbench::so3_test {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(So3, ExpIsUnitAndTurnsByTheAngleAboutTheAxis) {
  for (const Vector3& phi : awkward_rotations()) {
    const Rotation R = exp_so3(phi);
    EXPECT_NEAR(R.norm(), 1.0, 2e-15) << phi.transpose();
    const Eigen::AngleAxisd wanted(phi.norm(), phi.stableNormalized());
    EXPECT_NEAR((R.toRotationMatrix() - wanted.toRotationMatrix()).norm(), 0.0, 1e-14)
        << phi.transpose();
  }
}

TEST(So3, LogUndoesExp) {
  for (const Vector3& phi : awkward_rotations()) {
    const Vector3 back = log_so3(exp_so3(phi));
    // At pi both signs are the same rotation, and rounding of pi may pick either.
    const double other = phi.norm() > kPi - 1e-15 ? (back + phi).norm() : 1.0;
    EXPECT_NEAR(std::min((back - phi).norm(), other), 0.0, 1e-14) << phi.transpose();
  }
}

TEST(So3, LogKeepsRelativePrecisionOfSmallAngles) {
  for (const double angle : {1e-300, 1e-12, 1e-9, 1e-4, 1.9e-3, 2.1e-3}) {
    EXPECT_NEAR(log_so3(exp_so3(Vector3(0.0, angle, 0.0))).y() / angle, 1.0, 1e-15) << angle;
  }
}

TEST(So3, ExpUndoesLogForBothSignsOfTheQuaternion) {
  for (const Vector3& phi : awkward_rotations()) {
    const Rotation R = exp_so3(phi);
    const Rotation minus(-R.w(), -R.x(), -R.y(), -R.z());
    for (const Rotation& q : {R, minus}) {
      const Vector3 log = log_so3(q);
      EXPECT_LE(log.norm(), kPi + 1e-15);
      EXPECT_NEAR((exp_so3(log).toRotationMatrix() - R.toRotationMatrix()).norm(), 0.0, 2e-14);
    }
  }
}

TEST(So3, LogOfAHalfTurnHasLengthPi) {
  EXPECT_DOUBLE_EQ(log_so3(Rotation(0.0, 1.0, 0.0, 0.0)).x(), kPi);
  EXPECT_DOUBLE_EQ(log_so3(Rotation(-0.0, 0.0, 0.6, 0.8)).norm(), kPi);
}

TEST(So3, ExpTakesAnglesBeyondPi) {
  const Vector3 axis(0.6, 0.0, 0.8);
  EXPECT_NEAR((log_so3(exp_so3(1.5 * kPi * axis)) + 0.5 * kPi * axis).norm(), 0.0, 2e-15);
  EXPECT_NEAR(log_so3(exp_so3(2.0 * kPi * axis)).norm(), 0.0, 5e-15);
}

TEST(So3, HatIsTheCrossProduct) {
  const Vector3 a(1.0, -2.0, 3.0), b(0.5, 4.0, -1.0);
  EXPECT_TRUE((hat(a) * b).isApprox(a.cross(b), 1e-15));
}

TEST(So3, AngleBetweenIsSymmetricAndIgnoresTheWorld) {
  for (const Vector3& phi : awkward_rotations()) {
    const Rotation a = exp_so3(Vector3(0.3, -1.0, 2.0));
    const Rotation b = a * exp_so3(phi);
    EXPECT_NEAR(angle_between(a, b), phi.norm(), 5e-15);
    EXPECT_NEAR(angle_between(b, a), phi.norm(), 5e-15);
  }
}

TEST(So3, LeftJacobianIsTheDerivativeOfExp) {
  for (const Vector3& phi : awkward_rotations()) {
    const Rotation back = exp_so3(phi).conjugate();
    expect_jacobian("left", left_jacobian_so3(phi), [&](const Vector3& d) {
      return log_so3(exp_so3(phi + d) * back);
    });
  }
}

TEST(So3, InverseLeftJacobianIsTheDerivativeOfLog) {
  for (const Vector3& phi : awkward_rotations()) {
    if (phi.norm() > kPi - 1e-4) continue;  // log jumps at pi
    expect_jacobian("inverse left", inverse_left_jacobian_so3(phi), [&](const Vector3& d) {
      return log_so3(exp_so3(d) * exp_so3(phi));
    });
  }
}

TEST(So3, JacobianTimesInverseIsIdentity) {
  for (const Vector3& phi : awkward_rotations()) {
    const Matrix3 left = left_jacobian_so3(phi) * inverse_left_jacobian_so3(phi);
    EXPECT_NEAR((left - Matrix3::Identity()).norm(), 0.0, 1e-14) << phi.transpose();
  }
}

TEST(So3, NothingJumpsWhereSeriesMeetClosedForms) {
  for (const Vector3& axis : awkward_axes()) {
    const Vector3 below = kSmallAngle * (1.0 - 1e-14) * axis;
    const Vector3 above = kSmallAngle * (1.0 + 1e-14) * axis;
    EXPECT_NEAR((exp_so3(below).coeffs() - exp_so3(above).coeffs()).norm(), 0.0, 1e-16);
    EXPECT_NEAR((left_jacobian_so3(below) - left_jacobian_so3(above)).norm(), 0.0, 1e-15);
    EXPECT_NEAR(
        (inverse_left_jacobian_so3(below) - inverse_left_jacobian_so3(above)).norm(), 0.0, 5e-15);
  }
}

}  // namespace
}  // namespace loopbench::so3_test

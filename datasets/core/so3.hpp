/// SO(3) and its tangent space: exp, log and Jacobians.
///
/// A tangent vector is axis * angle [rad]. Source: Barfoot, State Estimation for Robotics, ch. 7.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

namespace loopbench {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;

/// Unit quaternion without over-alignment, so its layout does not depend on -march.
using Rotation = Eigen::Quaternion<double, Eigen::DontAlign>;

/// Below this angle the closed forms cancel and the Taylor series is accurate to double precision.
inline constexpr double kSmallAngle = 1e-3;  // [rad]; the first omitted term is below 1e-15

/// The matrix with hat(a) * b == a.cross(b).
inline Matrix3 hat(const Vector3& a) {
  Matrix3 out;
  out << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  return out;
}

/// Rotation by the angle |phi| about the axis phi. Accurate to rounding for every angle.
inline Rotation exp_so3(const Vector3& phi) {
  const double square = phi.squaredNorm();
  const double angle = std::sqrt(square);
  const double half_sinc = angle < kSmallAngle ? 0.5 - square / 48.0 + square * square / 3840.0
                                               : std::sin(0.5 * angle) / angle;
  Rotation out;
  out.w() = std::cos(0.5 * angle);
  out.vec() = half_sinc * phi;
  return out;
}

/// Shortest tangent vector, |log| <= pi. At exactly pi both signs are valid; one is returned.
inline Vector3 log_so3(const Rotation& rotation) {
  const double sign = rotation.w() < 0.0 ? -1.0 : 1.0;  // q and -q are the same rotation
  const double w = sign * rotation.w();
  const double sine = rotation.vec().norm();
  // Only 0 / 0 needs a special case: atan2 is accurate at small angles.
  const double angle_over_sine = sine > 0.0 ? 2.0 * std::atan2(sine, w) / sine : 2.0 / w;
  return sign * angle_over_sine * rotation.vec();
}

/// Angle of the relative rotation [rad], in 0..pi.
inline double angle_between(const Rotation& a, const Rotation& b) {
  return log_so3(a.conjugate() * b).norm();
}

/// Left Jacobian J: exp(phi + d) ~ exp(J d) exp(phi) (Barfoot 7.77).
inline Matrix3 left_jacobian_so3(const Vector3& phi) {
  const double square = phi.squaredNorm();
  const double angle = std::sqrt(square);
  const Matrix3 H = hat(phi);
  double a = 0.5 - square / 24.0;         // (1 - cos) / angle^2
  double b = 1.0 / 6.0 - square / 120.0;  // (angle - sin) / angle^3
  if (angle >= kSmallAngle) {
    const double half_sine = std::sin(0.5 * angle);
    a = 2.0 * half_sine * half_sine / square;
    b = (angle - std::sin(angle)) / (square * angle);
  }
  return Matrix3::Identity() + a * H + b * H * H;
}

/// Inverse of the left Jacobian, for |phi| < 2 pi.
inline Matrix3 inverse_left_jacobian_so3(const Vector3& phi) {
  const double square = phi.squaredNorm();
  const double angle = std::sqrt(square);
  const Matrix3 H = hat(phi);
  const double c =
      angle < kSmallAngle
          ? 1.0 / 12.0 + square / 720.0
          : (1.0 - 0.5 * angle * std::cos(0.5 * angle) / std::sin(0.5 * angle)) / square;
  return Matrix3::Identity() - 0.5 * H + c * H * H;
}

}  // namespace loopbench

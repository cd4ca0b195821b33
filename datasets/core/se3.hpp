/// SE(3) and its tangent space: exp, log, adjoint, Jacobians.
///
/// A twist is [rho; phi]: translation part first [m], rotation part second [rad].
/// Perturbations are on the right: pose * exp(twist). Source: Barfoot, ch. 7.
#pragma once

#include "datasets/core/pose.hpp"

namespace loopbench {

using Twist = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

inline Twist twist(const Vector3& rho, const Vector3& phi) {
  Twist out;
  out << rho, phi;
  return out;
}

inline Pose exp_se3(const Twist& xi) {
  const Vector3 phi = xi.tail<3>();
  return {exp_so3(phi), left_jacobian_so3(phi) * xi.head<3>()};
}

inline Twist log_se3(const Pose& pose) {
  const Vector3 phi = log_so3(pose.rotation);
  return twist(inverse_left_jacobian_so3(phi) * pose.translation, phi);
}

/// a * exp(xi) == exp(adjoint(a) * xi) * a.
inline Matrix6 adjoint(const Pose& a) {
  const Matrix3 R = a.rotation.toRotationMatrix();
  Matrix6 out = Matrix6::Zero();
  out.topLeftCorner<3, 3>() = R;
  out.topRightCorner<3, 3>() = hat(a.translation) * R;
  out.bottomRightCorner<3, 3>() = R;
  return out;
}

/// Upper right block of the left Jacobian (Barfoot 7.86b).
inline Matrix3 coupling_block_se3(const Vector3& rho, const Vector3& phi) {
  const double square = phi.squaredNorm();
  const double angle = std::sqrt(square);
  double a = 1.0 / 6.0 - square / 120.0;
  double b = 1.0 / 24.0 - square / 720.0;
  double c = 1.0 / 120.0 - square / 2520.0;
  // The closed form of c cancels to order angle^5, so the series is used up to a larger angle.
  if (angle >= 0.05) {
    const double s = std::sin(angle);
    const double k = std::cos(angle);
    const double chord = 2.0 * std::sin(0.5 * angle);
    a = (angle - s) / (square * angle);
    // square + 2 k - 2, as a product to avoid cancellation.
    b = (angle - chord) * (angle + chord) / (2.0 * square * square);
    c = (2.0 * angle - 3.0 * s + angle * k) / (2.0 * square * square * angle);
  } else {
    a += square * square / 5040.0;
    b += square * square / 40320.0;
    c += square * square / 120960.0;
  }
  const Matrix3 P = hat(phi);
  const Matrix3 Q = hat(rho);
  return 0.5 * Q + a * (P * Q + Q * P + P * Q * P) + b * (P * P * Q + Q * P * P - 3.0 * P * Q * P) +
         c * (P * Q * P * P + P * P * Q * P);
}

/// Left Jacobian J: exp(xi + d) ~ exp(J d) exp(xi).
inline Matrix6 left_jacobian_se3(const Twist& xi) {
  const Vector3 rho = xi.head<3>();
  const Vector3 phi = xi.tail<3>();
  Matrix6 out = Matrix6::Zero();
  out.topLeftCorner<3, 3>() = left_jacobian_so3(phi);
  out.topRightCorner<3, 3>() = coupling_block_se3(rho, phi);
  out.bottomRightCorner<3, 3>() = out.topLeftCorner<3, 3>();
  return out;
}

/// Inverse of the left Jacobian, for |phi| < 2 pi.
inline Matrix6 inverse_left_jacobian_se3(const Twist& xi) {
  const Vector3 rho = xi.head<3>();
  const Vector3 phi = xi.tail<3>();
  const Matrix3 J = inverse_left_jacobian_so3(phi);
  Matrix6 out = Matrix6::Zero();
  out.topLeftCorner<3, 3>() = J;
  out.topRightCorner<3, 3>() = -J * coupling_block_se3(rho, phi) * J;
  out.bottomRightCorner<3, 3>() = J;
  return out;
}

/// Right Jacobian J: exp(xi + d) ~ exp(xi) exp(J d).
inline Matrix6 right_jacobian_se3(const Twist& xi) { return left_jacobian_se3(-xi); }
inline Matrix6 inverse_right_jacobian_se3(const Twist& xi) {
  return inverse_left_jacobian_se3(-xi);
}

}  // namespace loopbench

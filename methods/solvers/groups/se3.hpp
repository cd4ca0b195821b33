/// Rigid motions of space with the interface of the pose-graph solver. A twist is [rho; phi].
#pragma once

#include "methods/solvers/groups/scaled_pose.hpp"

namespace loopbench::methods {

/// The same operations as Se2, implemented with datasets/core/se3.hpp.
struct Se3 {
  static constexpr int kDof = 6;
  static constexpr int kSize = 7;  ///< stored as qx, qy, qz, qw, x, y, z
  using Tangent = Twist;
  using Square = Matrix6;
  using Element = Pose;

  static Pose read(const double* from) {
    return {Rotation(from[3], from[0], from[1], from[2]), {from[4], from[5], from[6]}};
  }
  static void write(const Pose& pose, double* to) {
    Eigen::Map<Eigen::Vector4d> rotation(to);
    Eigen::Map<Vector3> translation(to + 4);
    rotation = pose.rotation.coeffs();
    translation = pose.translation;
  }
  static Pose compose(const Pose& a, const Pose& b) { return normalized(a * b); }
  static Pose inverse(const Pose& a) { return a.inverse(); }
  static Pose exp(const Twist& xi) { return exp_se3(xi); }
  static Twist log(const Pose& a) { return log_se3(a); }
  static Matrix6 adjoint(const Pose& a) { return loopbench::adjoint(a); }
  static Matrix6 inverse_right_jacobian(const Twist& xi) { return inverse_right_jacobian_se3(xi); }

  static Pose from(const ScaledPose& a) { return a.pose; }
  static ScaledPose to_scaled_pose(const Pose& a) { return {a, 1.0}; }
  static Matrix6 information(const Edge& edge, double) { return edge.information; }
};

}  // namespace loopbench::methods

/// Similarity transforms of space and their tangent space. A twist is [rho; phi; lambda], scale =
/// e^lambda.
#pragma once

#include "methods/solvers/groups/scaled_pose.hpp"

namespace loopbench::methods {

/// The same operations as Se2. Source: Strasdat, Local accuracy and global consistency for
/// efficient visual SLAM, 2012, section 2.4.4. The Jacobians are computed by halving the twist,
/// which is exact for every twist and needs no special case for small angles.
struct Sim3 {
  static constexpr int kDof = 7;
  static constexpr int kSize = 8;  ///< stored as qx, qy, qz, qw, x, y, z, log(scale)
  using Tangent = Eigen::Matrix<double, 7, 1>;
  using Square = Eigen::Matrix<double, 7, 7>;
  using Element = ScaledPose;

  static ScaledPose read(const double* from) {
    return {{Rotation(from[3], from[0], from[1], from[2]), {from[4], from[5], from[6]}},
            std::exp(from[7])};
  }
  static void write(const ScaledPose& a, double* to) {
    Eigen::Map<Eigen::Vector4d> rotation(to);
    Eigen::Map<Vector3> translation(to + 4);
    rotation = a.pose.rotation.coeffs();
    translation = a.pose.translation;
    to[7] = std::log(a.scale);
  }
  static ScaledPose compose(const ScaledPose& a, const ScaledPose& b) { return normalized(a * b); }
  static ScaledPose inverse(const ScaledPose& a) { return a.inverse(); }

  static ScaledPose exp(const Tangent& xi);
  static Tangent log(const ScaledPose& a);
  static Square adjoint(const ScaledPose& a);
  /// Returns the J in exp(xi + d) ~ exp(J d) exp(xi): the integral of Ad(exp(u xi)) over u in 0..1.
  static Square left_jacobian(Tangent xi);
  static Square inverse_right_jacobian(const Tangent& xi);

  static ScaledPose from(const ScaledPose& a) { return a; }
  static ScaledPose to_scaled_pose(const ScaledPose& a) { return a; }
  /// `scale_sigma` [-] is the deviation of the logarithm of the scale of edges that state none. An
  /// edge's translation and its deviations are in the scale of its first keyframe,
  /// but the error here follows the measured similarity and is in the scale of the second keyframe.
  static Square information(const Edge& edge, double scale_sigma) {
    Twist scale = Twist::Ones();
    scale.head<3>().setConstant(edge.scale);
    Square out = Square::Zero();
    out.topLeftCorner<6, 6>() = scale.asDiagonal() * edge.information * scale.asDiagonal();
    out(6, 6) = scale_information(edge, scale_sigma);
    return out;
  }
};

}  // namespace loopbench::methods

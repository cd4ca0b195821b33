/// Similarity transforms of space and their tangent space. A twist is [rho; phi; lambda], scale =
/// e^lambda.
#pragma once

#include <Eigen/LU>

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

  static ScaledPose exp(const Tangent& xi) {
    const Vector3 phi = xi.segment<3>(3);
    return {{exp_so3(phi), translation_jacobian(phi, xi[6]) * xi.head<3>()}, std::exp(xi[6])};
  }
  static Tangent log(const ScaledPose& a) {
    const Vector3 phi = log_so3(a.pose.rotation);
    const double lambda = std::log(a.scale);
    Tangent out;
    out << translation_jacobian(phi, lambda).partialPivLu().solve(a.pose.translation), phi, lambda;
    return out;
  }
  static Square adjoint(const ScaledPose& a) {
    const Matrix3 R = a.pose.rotation.toRotationMatrix();
    Square out = Square::Zero();
    out.topLeftCorner<3, 3>() = a.scale * R;
    out.block<3, 3>(0, 3) = hat(a.pose.translation) * R;
    out.block<3, 1>(0, 6) = -a.pose.translation;
    out.block<3, 3>(3, 3) = R;
    out(6, 6) = 1.0;
    return out;
  }
  /// Returns the J in exp(xi + d) ~ exp(J d) exp(xi): the integral of Ad(exp(u xi)) over u in 0..1.
  static Square left_jacobian(Tangent xi) {
    int halvings = 0;
    for (; xi.norm() > 0.25; ++halvings) xi *= 0.5;
    const Square ad = bracket(xi);
    Square out = Square::Identity();
    Square term = Square::Identity();
    for (int k = 2; k <= 14; ++k) {
      term = (term * ad).eval() / static_cast<double>(k);
      out += term;
    }
    for (; halvings > 0; --halvings) {
      out = (0.5 * (Square::Identity() + adjoint(exp(xi))) * out).eval();
      xi *= 2.0;
    }
    return out;
  }
  static Square inverse_right_jacobian(const Tangent& xi) { return left_jacobian(-xi).inverse(); }

  static ScaledPose from(const ScaledPose& a) { return a; }
  static ScaledPose to_scaled_pose(const ScaledPose& a) { return a; }
  /// Edges state no uncertainty of their scale; `scale_sigma` [-] is the deviation of its
  /// logarithm. An edge's translation and its deviations are in the scale of its first keyframe,
  /// but the error here follows the measured similarity and is in the scale of the second keyframe.
  static Square information(const Edge& edge, double scale_sigma) {
    Twist scale = Twist::Ones();
    scale.head<3>().setConstant(edge.scale);
    Square out = Square::Zero();
    out.topLeftCorner<6, 6>() = scale.asDiagonal() * edge.information * scale.asDiagonal();
    out(6, 6) = 1.0 / (scale_sigma * scale_sigma);
    return out;
  }

 private:
  /// Returns the matrix of [xi, .], the derivative of the adjoint.
  static Square bracket(const Tangent& xi) {
    Square out = Square::Zero();
    out.topLeftCorner<3, 3>() = hat(xi.segment<3>(3)) + xi[6] * Matrix3::Identity();
    out.block<3, 3>(0, 3) = hat(xi.head<3>());
    out.block<3, 1>(0, 6) = -xi.head<3>();
    out.block<3, 3>(3, 3) = hat(xi.segment<3>(3));
    return out;
  }

  /// Returns the W in translation(exp(xi)) = W rho: the integral of e^(u lambda) Exp(u phi) over u
  /// in 0..1.
  static Matrix3 translation_jacobian(const Vector3& phi, double lambda) {
    // Halving as in left_jacobian, for the 3 x 3 matrix A = hat(phi) + lambda I.
    const Matrix3 A = hat(phi) + lambda * Matrix3::Identity();
    int halvings = 0;
    double part = 1.0;
    const double size = std::sqrt(phi.squaredNorm() + lambda * lambda);
    for (; part * size > 0.25; ++halvings) part *= 0.5;
    Matrix3 out = Matrix3::Identity();
    Matrix3 term = Matrix3::Identity();
    for (int k = 2; k <= 14; ++k) {
      term = (term * A).eval() * (part / static_cast<double>(k));
      out += term;
    }
    for (; halvings > 0; --halvings) {
      const Matrix3 rotation = std::exp(part * lambda) * exp_so3(part * phi).toRotationMatrix();
      out = (0.5 * (Matrix3::Identity() + rotation) * out).eval();
      part *= 2.0;
    }
    return out;
  }
};

}  // namespace loopbench::methods

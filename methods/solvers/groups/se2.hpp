/// Planar rigid motions and their tangent space. A twist is [x, y, yaw] in [m], [m], [rad].
#pragma once

#include "methods/solvers/groups/scaled_pose.hpp"

namespace loopbench::methods {

/// Group operations for the pose-graph solver; Se3 and Sim3 have the same interface. Perturbations
/// act on the right: a * exp(twist). Source: Sola, Deray, Atchuthan, A micro Lie theory, 2018,
/// section IV. The Jacobian is B(ad) = ad / (e^ad - 1), in closed form through 2 x 2 blocks.
struct Se2 {
  static constexpr int kDof = 3;
  static constexpr int kSize = 3;  ///< stored as x, y, yaw
  using Tangent = Eigen::Matrix<double, 3, 1>;
  using Square = Eigen::Matrix<double, 3, 3>;
  struct Element {
    double x = 0.0, y = 0.0;  ///< [m]
    double yaw = 0.0;         ///< [rad], not wrapped
    double c = 1.0, s = 0.0;  ///< cosine and sine of yaw
  };

  static Element read(const double* from) {
    return {from[0], from[1], from[2], std::cos(from[2]), std::sin(from[2])};
  }
  static void write(const Element& e, double* to) { to[0] = e.x, to[1] = e.y, to[2] = e.yaw; }

  static Element compose(const Element& a, const Element& b) {
    return {a.x + a.c * b.x - a.s * b.y,
            a.y + a.s * b.x + a.c * b.y,
            a.yaw + b.yaw,
            a.c * b.c - a.s * b.s,
            a.s * b.c + a.c * b.s};
  }
  static Element inverse(const Element& a) {
    return {-a.c * a.x - a.s * a.y, a.s * a.x - a.c * a.y, -a.yaw, a.c, -a.s};
  }
  static Element exp(const Tangent& xi) {
    const double angle = xi[2];
    const double half = 0.5 * angle;
    const double half_sinc =
        std::abs(half) < kSmallAngle ? 1.0 - half * half / 6.0 : std::sin(half) / half;
    // V = sinc(half) R(half) maps the tangent of the arc to its chord.
    const double c = half_sinc * std::cos(half);
    const double s = half_sinc * std::sin(half);
    return {c * xi[0] - s * xi[1], s * xi[0] + c * xi[1], angle, std::cos(angle), std::sin(angle)};
  }
  static Tangent log(const Element& a) {
    const double angle = std::remainder(a.yaw, 2.0 * M_PI);
    const double along = half_cotangent(angle);
    const double across = 0.5 * angle;
    return {along * a.x + across * a.y, along * a.y - across * a.x, angle};
  }
  static Square adjoint(const Element& a) {
    Square out;
    out << a.c, -a.s, a.y, a.s, a.c, -a.x, 0.0, 0.0, 1.0;
    return out;
  }
  /// Inverse of the J in exp(xi + d) ~ exp(xi) exp(J d).
  static Square inverse_right_jacobian(const Tangent& xi) {
    const double angle = xi[2];
    const double along = half_cotangent(angle);
    const double across = 0.5 * angle;
    // (along - 1) / angle without cancellation
    const double small = std::abs(angle) < 1e-2 ? -angle / 12.0 - angle * angle * angle / 720.0
                                                : (along - 1.0) / angle;
    Square out;
    out << along, -across, 0.5 * xi[1] - small * xi[0],  //
        across, along, -0.5 * xi[0] - small * xi[1],     //
        0.0, 0.0, 1.0;
    return out;
  }

  /// Projection to the plane z = roll = pitch = 0.
  static Element from(const ScaledPose& a) {
    const Rotation& q = a.pose.rotation;
    const double yaw = 2.0 * std::atan2(q.z(), q.w());
    return {a.pose.translation.x(), a.pose.translation.y(), yaw, std::cos(yaw), std::sin(yaw)};
  }
  static ScaledPose to_scaled_pose(const Element& a) {
    return {{exp_so3({0.0, 0.0, a.yaw}), {a.x, a.y, 0.0}}, 1.0};
  }
  static Square information(const Edge& edge, double) {
    constexpr int axes[] = {0, 1, 5};
    Square out;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) out(i, j) = edge.information(axes[i], axes[j]);
    }
    return out;
  }

 private:
  /// (angle / 2) cot(angle / 2)
  static double half_cotangent(double angle) {
    const double half = 0.5 * angle;
    if (std::abs(half) < kSmallAngle) return 1.0 - half * half / 3.0;
    return half / std::tan(half);
  }
};

}  // namespace loopbench::methods

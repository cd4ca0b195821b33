/// Motions of space that keep the vertical: a twist is [x, y, z, yaw] in [m], [m], [m], [rad].
#pragma once

#include "methods/solvers/groups/se2.hpp"

namespace loopbench::methods {

/// The same operations as Se2, for poses whose z axis is vertical: those of Se2 in the horizontal
/// plane, and a height. A subgroup of SE(3), with its twists [rho; phi] where roll and pitch are
/// zero.
struct Level {
  static constexpr int kDof = 4;
  static constexpr int kSize = 4;               ///< stored as x, y, z, yaw
  static constexpr int kAxes[] = {0, 1, 2, 5};  ///< indices in [rho; phi]
  using Tangent = Eigen::Matrix<double, 4, 1>;
  using Square = Eigen::Matrix<double, 4, 4>;
  struct Element {
    Se2::Element flat;
    double z = 0.0;  ///< [m]
  };

  static Element read(const double* from) {
    const double flat[] = {from[0], from[1], from[3]};
    return {Se2::read(flat), from[2]};
  }
  static void write(const Element& e, double* to) {
    to[0] = e.flat.x, to[1] = e.flat.y, to[2] = e.z, to[3] = e.flat.yaw;
  }

  static Element compose(const Element& a, const Element& b) {
    return {Se2::compose(a.flat, b.flat), a.z + b.z};
  }
  static Element inverse(const Element& a) { return {Se2::inverse(a.flat), -a.z}; }
  static Element exp(const Tangent& xi) { return {Se2::exp(flat(xi)), xi[2]}; }
  static Tangent log(const Element& a) {
    const Se2::Tangent xi = Se2::log(a.flat);
    return {xi[0], xi[1], a.z, xi[2]};
  }
  static Square adjoint(const Element& a) { return with_height(Se2::adjoint(a.flat)); }
  static Square inverse_right_jacobian(const Tangent& xi) {
    return with_height(Se2::inverse_right_jacobian(flat(xi)));
  }

  /// Without roll and pitch.
  static Element from(const ScaledPose& a) { return {Se2::from(a), a.pose.translation.z()}; }
  static ScaledPose to_scaled_pose(const Element& a) {
    ScaledPose out = Se2::to_scaled_pose(a.flat);
    out.pose.translation.z() = a.z;
    return out;
  }
  static Square information(const Edge& edge, double) {
    Square out;
    for (int i = 0; i < kDof; ++i) {
      for (int j = 0; j < kDof; ++j) out(i, j) = edge.information(kAxes[i], kAxes[j]);
    }
    return out;
  }

 private:
  static Se2::Tangent flat(const Tangent& xi) { return {xi[0], xi[1], xi[3]}; }
  static Square with_height(const Se2::Square& flat) {
    constexpr int kRows[] = {0, 1, 3};
    Square out = Square::Identity();
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) out(kRows[i], kRows[j]) = flat(i, j);
    }
    return out;
  }
};

}  // namespace loopbench::methods

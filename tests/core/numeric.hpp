/// Tools for testing mathematics by its laws: tangents where formulas break, numeric derivatives.
#pragma once

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

#include "datasets/core/se3.hpp"

namespace loopbench {

/// Angles [rad] at zero, around every switch between series and closed form, and around pi.
inline std::vector<double> awkward_angles() {
  constexpr double pi = std::numbers::pi;
  return {0.0,
          1e-300,
          1e-12,
          1e-9,
          1e-4,
          kSmallAngle * (1.0 - 1e-9),
          kSmallAngle * (1.0 + 1e-9),
          0.05 * (1.0 - 1e-9),  // coupling_block_se3 switches here
          0.05 * (1.0 + 1e-9),
          1.0,
          0.5 * pi,
          pi - 1e-3,
          pi - 1e-7,
          pi - 1e-12,
          pi};
}

/// Unit vectors: the axes, both ways, and general ones.
inline std::vector<Vector3> awkward_axes() {
  return {Vector3::UnitX(),
          Vector3::UnitY(),
          Vector3::UnitZ(),
          -Vector3::UnitX(),
          -Vector3::UnitZ(),
          Vector3(1.0, 1.0, 1.0).normalized(),
          Vector3(0.3, -0.8, 0.52).normalized(),
          Vector3(-1e-8, 1.0, 1e-4).normalized()};
}

/// Rotation vectors with |phi| in 0..pi [rad].
inline std::vector<Vector3> awkward_rotations() {
  std::vector<Vector3> out;
  for (const double angle : awkward_angles()) {
    for (const Vector3& axis : awkward_axes()) out.push_back(angle * axis);
  }
  return out;
}

/// Twists: each awkward rotation with no, tiny, along-axis and general translation [m].
inline std::vector<Twist> awkward_twists() {
  std::vector<Twist> out;
  for (const Vector3& phi : awkward_rotations()) {
    for (const Vector3& rho : {Vector3(0.0, 0.0, 0.0),
                               Vector3(1e-9, -2e-9, 1e-12),
                               Vector3(3.0 * phi),
                               Vector3(1.0, -2.0, 0.5)}) {
      out.push_back(twist(rho, phi));
    }
  }
  return out;
}

/// A few poses in general position.
inline std::vector<Pose> general_poses() {
  return {exp_se3((Twist() << 1.0, 2.0, 3.0, 0.1, -0.2, 0.3).finished()),
          exp_se3((Twist() << -5.0, 0.1, 0.0, 2.0, 1.0, -1.5).finished()),
          exp_se3((Twist() << 0.0, 0.0, 100.0, 0.0, 0.0, 3.1).finished())};
}

inline double distance(const Pose& a, const Pose& b) {
  return (a.translation - b.translation).norm() +
         (a.rotation.toRotationMatrix() - b.rotation.toRotationMatrix()).norm();
}

/// Column k is (f(h e_k) - f(-h e_k)) / 2h, for f from R^n to R^m around zero.
template <int n, class Function>
auto numeric_jacobian(const Function& f, double h = 1e-5) {
  using Value = decltype(f(Eigen::Matrix<double, n, 1>::Zero().eval()));
  Eigen::Matrix<double, Value::RowsAtCompileTime, n> out;
  for (int k = 0; k < n; ++k) {
    Eigen::Matrix<double, n, 1> d = Eigen::Matrix<double, n, 1>::Zero();
    d(k) = h;
    const Value above = f(d);
    const Value below = f((-d).eval());
    out.col(k) = (above - below) / (2.0 * h);
  }
  return out;
}

/// Expects `analytic` to equal the central differences of f at zero, entry by entry, within
/// `tolerance` * max(1, largest entry). h is right for functions of unit curvature.
template <class Analytic, class Function>
void expect_jacobian(const char* what,
                     const Analytic& analytic,
                     const Function& f,
                     double tolerance = 1e-8) {
  const auto numeric = numeric_jacobian<Analytic::ColsAtCompileTime>(f);
  const double size = std::max(1.0, analytic.cwiseAbs().maxCoeff());
  EXPECT_LE((analytic - numeric).cwiseAbs().maxCoeff(), tolerance * size)
      << what << "\nanalytic\n"
      << analytic << "\nnumeric\n"
      << numeric;
}

}  // namespace loopbench

/// Information matrices of g2o: conversion to twists, and repair of those that are not positive
/// definite.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <optional>
#include <utility>

#include "datasets/core/problem.hpp"
#include "datasets/core/se3.hpp"
#include "datasets/formats/g2o.hpp"

namespace loopbench {

/// g2o's error of a measurement Z is the vector [t; q_xyz] of Delta = Z^-1 Xi^-1 Xj with q_w >= 0.
/// Near zero q_xyz = phi / 2 and t = rho, so
/// Omega_phi = Omega_q / 4 and Omega_t,phi = Omega_tq / 2.
inline Matrix6 from_half_angles(const Matrix6& half) {
  Matrix6 out = half;
  out.topRightCorner<3, 3>() *= 0.5;
  out.bottomLeftCorner<3, 3>() *= 0.5;
  out.bottomRightCorner<3, 3>() *= 0.25;
  return out;
}

inline Matrix6 to_half_angles(const Matrix6& twist_information) {
  Matrix6 out = twist_information;
  out.topRightCorner<3, 3>() *= 2.0;
  out.bottomLeftCorner<3, 3>() *= 2.0;
  out.bottomRightCorner<3, 3>() *= 4.0;
  return out;
}

/// Indices of x, y and yaw in a twist.
inline constexpr int kPlanarAxes[] = {0, 1, 5};

/// Lifts information of (x, y, yaw) to a twist. z gets the mean information of x and y; roll and
/// pitch get that of yaw. These values do not affect the solution: z, roll and pitch residuals of
/// planar poses are exactly zero, and the adjoint of a planar motion does not mix them with the
/// others.
inline Matrix6 lift_planar(const Matrix3& planar) {
  Matrix6 out = Matrix6::Zero();
  out(2, 2) = 0.5 * (planar(0, 0) + planar(1, 1));
  out(3, 3) = out(4, 4) = planar(2, 2);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) out(kPlanarAxes[i], kPlanarAxes[j]) = planar(i, j);
  }
  return out;
}

inline Matrix3 planar_block(const Matrix6& lifted) {
  Matrix3 out;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) out(i, j) = lifted(kPlanarAxes[i], kPlanarAxes[j]);
  }
  return out;
}

/// Information of the inverse measurement: (Z exp(e))^-1 = Z^-1 exp(-Ad(Z) e), so e = -Ad(Z^-1) e'
/// leaves the quadratic form unchanged.
inline Matrix6 information_of_inverse(const Pose& a_from_b, const Matrix6& information) {
  const Matrix6 A = adjoint(a_from_b.inverse());
  const Matrix6 out = A.transpose() * information * A;
  return 0.5 * (out + out.transpose());
}

/// The measurement from `to` to `from`. Translations of a similarity edge keep their scale, as in
/// COP-SLAM, the source of these files.
inline Edge inverted(Edge edge) {
  std::swap(edge.from, edge.to);
  edge.information = information_of_inverse(edge.from_from_to, edge.information);
  edge.from_from_to = edge.from_from_to.inverse();
  edge.scale = 1.0 / edge.scale;
  return edge;
}

template <class Square>
bool is_positive_definite(const Square& information) {
  return information.allFinite() && information.llt().info() == Eigen::Success;
}

/// cubicle.g2o stores the terms x, yaw and y, yaw of planar edges at z, roll and z, pitch.
inline Matrix6 with_planar_terms(Matrix6 information) {
  for (int axis = 0; axis < 2; ++axis) {
    std::swap(information(axis, 5), information(2, 3 + axis));
    std::swap(information(5, axis), information(3 + axis, 2));
  }
  return information;
}

/// Raises eigenvalues to at least 1e-6 of the largest.
template <class Square>
Square with_positive_eigenvalues(const Square& information) {
  const Eigen::SelfAdjointEigenSolver<Square> eigen(information);
  const auto values = eigen.eigenvalues().cwiseMax(1e-6 * eigen.eigenvalues().maxCoeff()).eval();
  const Square out = eigen.eigenvectors() * values.asDiagonal() * eigen.eigenvectors().transpose();
  return 0.5 * (out + out.transpose());
}

/// Returns a positive definite matrix in place of one that is not; nullopt if that is not possible.
template <int N>
std::optional<Eigen::Matrix<double, N, N>> made_definite(
    const Eigen::Matrix<double, N, N>& information, IndefiniteInformation how) {
  Eigen::Matrix<double, N, N> out = information;
  switch (how) {
    case IndefiniteInformation::reject:
      return std::nullopt;
    case IndefiniteInformation::repair:
      if constexpr (N == 6) out = with_planar_terms(information);
      break;
    case IndefiniteInformation::project:
      out = with_positive_eigenvalues(information);
      break;
  }
  if (!is_positive_definite(out)) return std::nullopt;
  return out;
}

}  // namespace loopbench

/// Information matrices that are not positive definite.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <optional>
#include <utility>

#include "datasets/formats/g2o.hpp"

namespace loopbench {

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

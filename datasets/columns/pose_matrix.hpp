/// Matrices of poses: few digits, a scale, zeros.
#pragma once

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>

#include "datasets/columns/reading.hpp"
#include "datasets/core/closest_rotation.hpp"
#include "datasets/core/pose.hpp"

namespace loopbench {

/// Largest deviation of a matrix from orthonormal, R R^T - I.
inline double off_orthonormal(const Matrix3& R) {
  return (R * R.transpose() - Matrix3::Identity()).cwiseAbs().maxCoeff();
}

/// Whether a row stands for a frame without a pose: a rotation of zeros, or no finite numbers.
inline bool is_missing(const PoseMatrix& pose) {
  return pose.linear().isZero(0.0) || !pose.matrix().allFinite();
}

/// Makes the rotation orthonormal if it is within 0.05, with a scale or without, and not within
/// 1e-3, as files with six digits are. The findings state deviation and scale; the position stays
/// as it is. Returns why it is no rotation; empty: it is one.
inline std::string normalise_matrix(PoseMatrix& pose, ReadFindings& found) {
  constexpr double kSixDigits = 1e-3, kMost = 0.05;
  Matrix3 R = pose.linear();
  double deviation = off_orthonormal(R);
  if (!(deviation <= kMost)) {
    const double scale = std::cbrt(std::abs(R.determinant()));
    const double rest = off_orthonormal(R / scale);
    if (!(rest <= kMost)) {
      return fmt::format(
          "rotation deviates from orthonormal by {:.3g}, expected at most {} (of a matrix without "
          "its scale)",
          std::isfinite(rest) ? rest : deviation,
          kMost);
    }
    if (R.determinant() > 0.0) found.scales.add({1, scale, scale});
    R /= scale;
    deviation = rest;
  }
  if (R.determinant() < 0.0) return "determinant is -1 (a reflection), expected a rotation";
  const bool is_exact = deviation <= kSixDigits;
  if (!is_exact) found.off_orthonormal = std::max(found.off_orthonormal, deviation);
  if (!is_exact) R = closest_rotation(R);
  pose.linear() = R;
  return "";
}

}  // namespace loopbench

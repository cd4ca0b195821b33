/// The rotation that is closest to a matrix.
#pragma once

#include <Eigen/LU>
#include <Eigen/SVD>

#include "datasets/core/se3.hpp"

namespace loopbench {

/// The rotation R with the largest trace of R^T M (Kabsch 1976).
inline Matrix3 closest_rotation(const Matrix3& m) {
  const Eigen::JacobiSVD<Matrix3> svd(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix3 u = svd.matrixU();
  if ((u * svd.matrixV().transpose()).determinant() < 0.0) u.col(2) = -u.col(2);
  return u * svd.matrixV().transpose();
}

}  // namespace loopbench

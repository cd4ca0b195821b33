#include "datasets/core/closest_rotation.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>

namespace loopbench {

Matrix3 closest_rotation(const Matrix3& m) {
  const Eigen::JacobiSVD<Matrix3> svd(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix3 u = svd.matrixU();
  if ((u * svd.matrixV().transpose()).determinant() < 0.0) u.col(2) = -u.col(2);
  return u * svd.matrixV().transpose();
}

Vector3 singular_values(const Matrix3& m) { return Eigen::JacobiSVD<Matrix3>(m).singularValues(); }

}  // namespace loopbench

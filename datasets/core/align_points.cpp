#include "datasets/core/align_points.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>

namespace loopbench {

Eigen::Matrix4d align_points(const Eigen::Matrix3Xd& from,
                             const Eigen::Matrix3Xd& to,
                             bool scaled) {
  return Eigen::umeyama(from, to, scaled);
}

Eigen::Matrix3d align_points(const Eigen::Matrix2Xd& from,
                             const Eigen::Matrix2Xd& to,
                             bool scaled) {
  return Eigen::umeyama(from, to, scaled);
}

}  // namespace loopbench

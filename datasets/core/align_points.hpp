/// Least-squares alignment of paired points (Umeyama, PAMI 1991). Compiled once: Eigen's template
/// takes seconds.
#pragma once

#include <Eigen/Core>

namespace loopbench {

/// Homogeneous matrix of the rotation and translation, with `scaled` also the scale, that map the
/// columns of `from` to those of `to` with the smallest sum of squared distances. O(n).
Eigen::Matrix4d align_points(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to, bool scaled);
Eigen::Matrix3d align_points(const Eigen::Matrix2Xd& from, const Eigen::Matrix2Xd& to, bool scaled);

}  // namespace loopbench

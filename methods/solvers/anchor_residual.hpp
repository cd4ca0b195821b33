/// Residual of an anchor and its derivative with respect to the pose of its keyframe.
#pragma once

#include "datasets/core/anchor.hpp"

namespace loopbench::methods {

/// e = anchor_error() and its derivative with respect to d in X Exp(d), with d = [rho; phi].
struct AnchorResidual {
  Vector3 error;
  Eigen::Matrix<double, 3, 6> by_pose;
};

inline AnchorResidual anchor_residual(const Anchor& anchor, const Pose& world_from_body) {
  const Matrix3 R = world_from_body.rotation.toRotationMatrix();
  AnchorResidual out;
  out.error = anchor_error(anchor, world_from_body);
  out.by_pose << R, -R * hat(anchor.point_in_body);
  return out;
}

}  // namespace loopbench::methods

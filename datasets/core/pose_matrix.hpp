/// A pose as a 3 x 4 matrix with the digits of its file.
#pragma once

#include <Eigen/Geometry>

namespace loopbench {

/// The upper 3 x 4 block of world_from_body [m]. Its left 3 x 3 block is orthonormal only to the
/// printed digits. It is needed to reproduce tools that use the matrix without normalising it
/// (KITTI devkit); otherwise use Pose.
using PoseMatrix = Eigen::AffineCompact3d;

}  // namespace loopbench

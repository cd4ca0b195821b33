/// A pose as a file prints it.
#pragma once

#include <Eigen/Geometry>

namespace loopbench {

/// The upper 3 x 4 of world_from_body [m]. Its digits are rounded, so the left 3 x 3 is a rotation
/// to those digits only; whoever must reproduce a tool that computes with it as it stands (KITTI's)
/// needs this, everybody else a Pose.
using PoseMatrix = Eigen::AffineCompact3d;

}  // namespace loopbench

/// Poses in left-handed coordinates.
#pragma once

#include "datasets/core/pose.hpp"

namespace loopbench {

/// The pose with one axis (0..2) of world and body reversed: positions M p, rotations M R M.
inline Pose mirrored(Pose pose, int axis) {
  const double of_axis = pose.rotation.vec()[axis];
  pose.rotation.vec() = -pose.rotation.vec();
  pose.rotation.vec()[axis] = of_axis;
  pose.translation[axis] = -pose.translation[axis];
  return pose;
}

}  // namespace loopbench

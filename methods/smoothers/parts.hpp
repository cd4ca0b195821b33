/// Positions and rotations of a keyframe list, for smoothers that process them separately.
#pragma once

#include <vector>

#include "datasets/core/trajectory.hpp"

namespace loopbench::methods {

inline std::vector<Vector3> positions_of(const Trajectory& poses) {
  std::vector<Vector3> out;
  out.reserve(poses.size());
  for (const StampedPose& pose : poses) out.push_back(pose.world_from_body.translation);
  return out;
}

inline std::vector<Rotation> attitudes(const Trajectory& poses) {
  std::vector<Rotation> out;
  out.reserve(poses.size());
  for (const StampedPose& pose : poses) out.push_back(pose.world_from_body.rotation);
  return out;
}

}  // namespace loopbench::methods

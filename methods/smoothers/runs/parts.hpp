/// Positions and rotations of a keyframe list, for smoothers that process them separately, and the
/// check of its size.
#pragma once

#include <string>
#include <vector>

#include "datasets/core/trajectory.hpp"

namespace loopbench::methods {

inline std::vector<Vector3> positions_of(const Trajectory& poses) {
  std::vector<Vector3> out;
  out.reserve(poses.size());
  for (const StampedPose& pose : poses) out.push_back(pose.world_from_body.translation);
  return out;
}

inline std::vector<Rotation> rotations_of(const Trajectory& poses) {
  std::vector<Rotation> out;
  out.reserve(poses.size());
  for (const StampedPose& pose : poses) out.push_back(pose.world_from_body.rotation);
  return out;
}

/// Returns why a method that requires `least` keyframes declines, or an empty text.
inline std::string too_few_keyframes(const Trajectory& keyframes, std::size_t least) {
  if (keyframes.size() >= least) return "";
  return std::to_string(keyframes.size()) + " keyframes, fewer than " + std::to_string(least);
}

}  // namespace loopbench::methods

/// Trajectories: lists of stamped poses.
#pragma once

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "datasets/core/error.hpp"
#include "datasets/core/pose.hpp"

namespace loopbench {

struct StampedPose {
  double stamp = 0.0;  ///< [s]
  Pose world_from_body;
};
static_assert(sizeof(StampedPose) == 64,
              "a stamped pose must fill one cache line for any compiler flags");

/// Stamps strictly increase, quaternions are unit, all values are finite: see check(). A reference
/// can consist of positions alone, all with no_rotation().
using Trajectory = std::vector<StampedPose>;

/// Whether the poses are positions without rotations; then no pose has a rotation, see check().
inline bool lacks_rotations(const Trajectory& trajectory) {
  return !trajectory.empty() && !has_rotation(trajectory.front().world_from_body);
}

/// Whether a trajectory may consist of positions without rotations.
enum class Rotations { needed, optional };

/// Throws InputError with `name`, the pose index and the violated rule if the trajectory is
/// invalid. O(n).
inline void check(const Trajectory& trajectory,
                  const std::string& name,
                  Rotations rotations = Rotations::needed) {
  const bool only_positions = rotations == Rotations::optional && lacks_rotations(trajectory);
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const auto invalid = [&](const std::string& what) {
      return InputError(name + ": pose " + std::to_string(i) + ": " + what);
    };
    const auto& [stamp, pose] = trajectory[i];
    if (!std::isfinite(stamp) || !pose.translation.allFinite()) throw invalid("is not finite");
    if (only_positions && has_rotation(pose)) throw invalid("has a rotation, the first has none");
    if (!only_positions && !pose.rotation.coeffs().allFinite()) throw invalid("is not finite");
    if (!only_positions && std::abs(pose.rotation.norm() - 1.0) > 1e-6)
      throw invalid("quaternion is not unit");
    if (i > 0 && !(stamp > trajectory[i - 1].stamp)) throw invalid("stamp does not increase");
  }
}

/// Sum of the distances between consecutive poses [m]. O(n).
inline double path_length(const Trajectory& trajectory) {
  double length = 0.0;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    length +=
        (trajectory[i].world_from_body.translation - trajectory[i - 1].world_from_body.translation)
            .norm();
  }
  return length;
}

inline std::vector<double> stamps(const Trajectory& trajectory) {
  std::vector<double> out;
  out.reserve(trajectory.size());
  for (const StampedPose& pose : trajectory) out.push_back(pose.stamp);
  return out;
}

}  // namespace loopbench

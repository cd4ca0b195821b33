/// Rules that every estimated pose must satisfy.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

#include "datasets/core/params.hpp"
#include "datasets/core/trajectory.hpp"

namespace loopbench {

inline constexpr double kUnitTolerance = 1e-6;     ///< of the norm of a quaternion, as in check()
inline constexpr double kFarthestPosition = 1e12;  ///< [m]; beyond it a double resolves no 0.1 mm

/// Returns the rule that the pose violates; empty if it satisfies all:
/// - position: finite, no coordinate beyond +-1e12 m;
/// - rotation: finite, quaternion norm 1 +- 1e-6.
inline std::string violated_rule(const Pose& pose) {
  if (!pose.translation.allFinite()) return "the position is not finite";
  if (pose.translation.cwiseAbs().maxCoeff() > kFarthestPosition) {
    return "the position is beyond 1e12 m";
  }
  if (!pose.rotation.coeffs().allFinite()) return "the rotation is not finite";
  const double norm = pose.rotation.norm();
  if (std::abs(norm - 1.0) <= kUnitTolerance) return "";
  return "the quaternion has norm " + to_text(norm) + ", expected 1 within 1e-6";
}

/// normalise() for a quaternion from memory. Throws std::runtime_error with `name`.
inline Rotation unit_rotation(Rotation given, const std::string& name, double& off_unit) {
  if (normalise(given, off_unit)) return given;
  throw std::runtime_error(name + ": quaternion has norm " + std::to_string(given.norm()) +
                           ", expected 1 +- 0.01");
}

/// Throws std::runtime_error for poses that violate a rule. The message names the first pose, its
/// stamp and rule, and the number of such poses: "keyframe 3 of 180, at 2.5 s: the position is not
/// finite (12 such poses)". `what` names one pose. O(n).
inline void require_valid(const Trajectory& poses, std::string_view what) {
  std::string first;
  std::size_t count = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const std::string rule = violated_rule(poses[i].world_from_body);
    if (rule.empty() || ++count > 1) continue;
    first.append(what).append(" " + std::to_string(i + 1) + " of " + std::to_string(poses.size()));
    first += ", at " + to_text(poses[i].stamp) + " s: " + rule;
  }
  if (count == 0) return;
  if (count > 1) first += " (" + std::to_string(count) + " such poses)";
  throw std::runtime_error(first);
}

}  // namespace loopbench

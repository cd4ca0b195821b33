/// Axes of positions against axes of rotations, from displacements over short distances.
#pragma once

#include <string>
#include <vector>

#include "datasets/core/pose.hpp"

namespace loopbench::metrics {

struct AxisFit {
  Matrix3 axes = Matrix3::Identity();  ///< signed permutation of the estimate's positions that fits
  double as_read = 0.0;                ///< relative error of displacements without it [-]
  double changed = 0.0;                ///< with it [-]

  /// Source axis of each axis, for example "x -y z".
  std::string text() const;
  /// The same for an option: "x,-y,z".
  std::string option() const;
};

/// Compares displacements of both trajectories in their body frames, which drift does not change,
/// up to a constant rotation of the body and a scale: for the positions as read, and for each of
/// the 48 signed permutations of the estimate's positions. Of permutations that fit equally well,
/// as on a plane, the one that moves the fewest axes is chosen. Errors are 0 below eight poses.
/// O(n).
AxisFit fit_axes(const std::vector<Pose>& reference, const std::vector<Pose>& estimate);

}  // namespace loopbench::metrics

/// Axes in which the article's equations y = f(x) and z = q(x, y) are fitted. The article does not
/// state them, and every such curve depends on them.
#pragma once

#include <array>
#include <memory>

#include "datasets/core/curve.hpp"
#include "datasets/core/problem.hpp"
#include "datasets/core/trajectory.hpp"

namespace loopbench::methods::manifold {

enum class UpDirection { pca, world_z };
inline auto choices(UpDirection) {
  return std::array{std::pair{"pca", UpDirection::pca}, std::pair{"world_z", UpDirection::world_z}};
}

/// Unit vector in the world. `pca` is the axis of least variance of the positions, so the result
/// rotates with the data. If this axis is not unique (straight line, at rest, equal variances) a
/// body axis of the first pose is used, which rotates with the data as well. The sign follows the
/// direction of travel; the fits do not depend on it, because mirrored z' and y' give mirrored
/// curves. O(n).
Vector3 up_axis(const Trajectory& nodes, UpDirection choice);

/// estimate: axes of the estimate's world frame (for ORB-SLAM2 those of the first camera).
/// gravity: z up, x along the largest horizontal variance, see level_axes(). reference: axes of the
/// reference, which a method has no access to: rejected, `paper_reference_axes` fits in them.
enum class FitAxes { estimate, gravity, reference };
inline auto choices(FitAxes) {
  return std::array{std::pair{"estimate", FitAxes::estimate},
                    std::pair{"gravity", FitAxes::gravity},
                    std::pair{"reference", FitAxes::reference}};
}

/// Plane of the planar curve: y = f(x), z = f(y) or z = f(x) (article, below equation 9).
enum class Plane { xoy, yoz, xoz };
inline auto choices(Plane) {
  return std::array{
      std::pair{"xoy", Plane::xoy}, std::pair{"yoz", Plane::yoz}, std::pair{"xoz", Plane::xoz}};
}

/// Rotation axes_from_world to axes with z up, estimated without an IMU. z is the direction most
/// nearly perpendicular to the cameras' x axes, because a camera that is carried around rarely
/// rolls; upwards is where their y axes do not point. x is the horizontal direction of largest
/// variance of the positions, towards the pose farthest from the first. Requires a camera's axes (x
/// right, y down) as body frame and rotation about more than one axis; the error on the ORB-SLAM2
/// runs of the article's sequences is 1 to 5 degrees (tests/external/paper_test.py). The
/// result rotates with the data. O(n).
Rotation level_axes(const Trajectory& poses);

/// Rotation from (x, y, z) to axes whose first two span the plane.
Rotation plane_axes(Plane plane);

/// The problem in rotated axes, with its first keyframe at the origin. Edges are relative and
/// unchanged. O(keyframes + frames).
Problem in_axes(const Problem& problem, const Rotation& axes_from_world);

/// `curve` of in_axes(problem, axes_from_world) in the world frame of `problem`.
std::unique_ptr<const Curve> in_world(std::unique_ptr<const Curve> curve,
                                      const Problem& problem,
                                      const Rotation& axes_from_world);

}  // namespace loopbench::methods::manifold

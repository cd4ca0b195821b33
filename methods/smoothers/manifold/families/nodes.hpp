/// Nodes to which the manifold smoother fits curves, and ranges of nodes.
#pragma once

#include <cstddef>
#include <vector>

#include "datasets/core/trajectory.hpp"

namespace loopbench::methods::manifold {

/// Nodes first..last, both included; neighbouring ranges share their end node.
struct NodeRange {
  std::size_t first = 0;
  std::size_t last = 0;

  std::size_t nodes() const { return last - first + 1; }
  bool operator==(const NodeRange&) const = default;
};

/// Keyframes and quasi-keyframes with positions relative to the first one, which avoids rounding
/// errors far from the world origin and any dependence on that origin.
struct Nodes {
  std::vector<double> stamps;      ///< [s], strictly increasing
  std::vector<Vector3> points;     ///< relative to `base` [m]
  Vector3 base = {0.0, 0.0, 0.0};  ///< position of the first node [m]

  explicit Nodes(const Trajectory& poses) : stamps(loopbench::stamps(poses)) {
    if (!poses.empty()) base = poses.front().world_from_body.translation;
    points.reserve(poses.size());
    for (const StampedPose& pose : poses) {
      points.push_back(pose.world_from_body.translation - base);
    }
  }

  std::size_t size() const { return points.size(); }
  Vector3 step(std::size_t edge) const { return points[edge + 1] - points[edge]; }
  double duration(std::size_t edge) const { return stamps[edge + 1] - stamps[edge]; }
};

/// Angle between two directions, 0..pi [rad]; 0 when either is zero. Uses atan2, because acos loses
/// half the digits for nearly parallel directions.
inline double angle_between_directions(const Vector3& a, const Vector3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Menger curvature: one over the radius of the circle through three points [1/m]; 0 if two
/// coincide.
inline double discrete_curvature(const Vector3& a, const Vector3& b, const Vector3& c) {
  const Vector3 ab = b - a;
  const Vector3 bc = c - b;
  const double sides = ab.norm() * bc.norm() * (c - a).norm();
  return sides > 0.0 ? 2.0 * ab.cross(bc).norm() / sides : 0.0;
}

}  // namespace loopbench::methods::manifold

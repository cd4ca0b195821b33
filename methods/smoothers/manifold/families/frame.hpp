/// Fitting frame of a window, and the test whether its nodes are a graph y' = f(x').
#pragma once

#include <array>
#include <numbers>
#include <optional>
#include <span>

#include "methods/smoothers/manifold/families/nodes.hpp"

namespace loopbench::methods::manifold {

using Vector2 = Eigen::Vector2d;

/// chord: x' from the first to the last node. world: world axes, as in the article.
enum class Axes { chord, world };
inline auto choices(Axes) {
  return std::array{std::pair{"chord", Axes::chord}, std::pair{"world", Axes::world}};
}

struct Frame {
  Vector3 origin;  ///< the first node or the world origin [m]
  Vector3 x;       ///< unit vector, along the chord projected along the up axis
  Vector3 y;       ///< unit vector, to the left; z' is up

  Vector2 local(const Vector3& point) const {
    const Vector3 from_origin = point - origin;
    return {x.dot(from_origin), y.dot(from_origin)};
  }
};

// Minimum chord as a fraction of the path length; below it, rounding determines the direction.
inline constexpr double kLeastChord = 1e-6;
inline constexpr double kLeastAdvance = 0.1;                    // fraction of the mean step
inline constexpr double kMostTurning = std::numbers::pi / 2.0;  // [rad]

/// Frame with x' from the first to the last node, projected so that z' is exactly `up`. Returns
/// nullopt when the projected chord is too short: at rest, or for a closed or vertical window.
inline std::optional<Frame> chord_frame(const Nodes& nodes, NodeRange range, const Vector3& up) {
  double length = 0.0;
  for (std::size_t edge = range.first; edge < range.last; ++edge) length += nodes.step(edge).norm();
  const Vector3 chord = nodes.points[range.last] - nodes.points[range.first];
  const Vector3 level = chord - up.dot(chord) * up;
  if (!(level.norm() > kLeastChord * length)) return std::nullopt;
  const Vector3 x = level.normalized();
  return Frame{nodes.points[range.first], x, up.cross(x)};
}

/// Frame of a window for `axes`.
inline std::optional<Frame> fitting_frame(Axes axes,
                                          const Nodes& nodes,
                                          NodeRange range,
                                          const Vector3& up) {
  if (axes == Axes::world) return Frame{-nodes.base, Vector3::UnitX(), Vector3::UnitY()};
  return chord_frame(nodes, range, up);
}

/// Guard: true if every step advances by more than a tenth of the mean step and the total rotation
/// angle is below a right angle. Otherwise y = f(x) may be multivalued, as on any loop.
inline bool is_graph(std::span<const Vector2> points) {
  double length = 0.0;
  double turning = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Vector2 step = points[i] - points[i - 1];
    length += step.norm();
    if (i < 2) continue;
    const Vector2 before = points[i - 1] - points[i - 2];
    const double cross = before.x() * step.y() - before.y() * step.x();
    turning += std::abs(std::atan2(cross, before.dot(step)));
  }
  const double least = kLeastAdvance * length / static_cast<double>(points.size() - 1);
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (!(points[i].x() - points[i - 1].x() > least)) return false;
  }
  return turning < kMostTurning;
}

}  // namespace loopbench::methods::manifold

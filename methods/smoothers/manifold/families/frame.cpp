#include "methods/smoothers/manifold/families/frame.hpp"

#include <numbers>

namespace loopbench::methods::manifold {
namespace {

// Minimum chord as a fraction of the path length; below it, rounding determines the direction.
constexpr double kLeastChord = 1e-6;
constexpr double kLeastAdvance = 0.1;                    // fraction of the mean step
constexpr double kMostTurning = std::numbers::pi / 2.0;  // [rad]

}  // namespace

std::optional<Frame> chord_frame(const Nodes& nodes, NodeRange range, const Vector3& up) {
  double length = 0.0;
  for (std::size_t edge = range.first; edge < range.last; ++edge) length += nodes.step(edge).norm();
  const Vector3 chord = nodes.points[range.last] - nodes.points[range.first];
  const Vector3 level = chord - up.dot(chord) * up;
  if (!(level.norm() > kLeastChord * length)) return std::nullopt;
  const Vector3 x = level.normalized();
  return Frame{nodes.points[range.first], x, up.cross(x)};
}

std::optional<Frame> fitting_frame(Axes axes,
                                   const Nodes& nodes,
                                   NodeRange range,
                                   const Vector3& up) {
  if (axes == Axes::world) return Frame{-nodes.base, Vector3::UnitX(), Vector3::UnitY()};
  return chord_frame(nodes, range, up);
}

bool is_graph(std::span<const Vector2> points) {
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

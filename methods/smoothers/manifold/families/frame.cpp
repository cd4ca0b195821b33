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

std::optional<Frame> pca_frame(const Nodes& nodes, NodeRange range, const Vector3& up) {
  constexpr double alike = 1e-6;  // relative variance difference of an undetermined axis
  const auto chord = chord_frame(nodes, range, up);
  if (!chord) return std::nullopt;
  const std::vector<Vector2> points = local(nodes, range, *chord);
  Vector2 mean = Vector2::Zero();
  for (const Vector2& point : points) mean += point / static_cast<double>(points.size());
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (const Vector2& point : points) {
    const Vector2 d = point - mean;
    xx += d.x() * d.x();
    xy += d.x() * d.y();
    yy += d.y() * d.y();
  }
  if (std::hypot(xx - yy, 2.0 * xy) < alike * (xx + yy)) return std::nullopt;
  const double angle = 0.5 * std::atan2(2.0 * xy, xx - yy);
  Vector2 axis(std::cos(angle), std::sin(angle));
  if (std::abs(axis.x()) < alike) return std::nullopt;  // perpendicular to the chord
  if (axis.x() < 0.0) axis = -axis;
  const Vector3 x = axis.x() * chord->x + axis.y() * chord->y;
  return Frame{chord->origin, x, up.cross(x)};
}

std::optional<Frame> fitting_frame(Axes axes,
                                   const Nodes& nodes,
                                   NodeRange range,
                                   const Vector3& up) {
  if (axes == Axes::world) return Frame{-nodes.base, Vector3::UnitX(), Vector3::UnitY()};
  return axes == Axes::pca ? pca_frame(nodes, range, up) : chord_frame(nodes, range, up);
}

std::vector<Vector2> local(const Nodes& nodes, NodeRange range, const Frame& frame) {
  std::vector<Vector2> out;
  out.reserve(range.nodes());
  for (std::size_t i = range.first; i <= range.last; ++i) {
    out.push_back(frame.local(nodes.points[i]));
  }
  return out;
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

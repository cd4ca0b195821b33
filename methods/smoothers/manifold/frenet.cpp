#include "methods/smoothers/manifold/frenet.hpp"

namespace loopbench::methods::manifold {
namespace {

constexpr double kStraight = 1e-9;  // [rad] between S' and S''; below it, the plane is undetermined

// v reflected in the plane perpendicular to `along`.
Vector3 mirrored(const Vector3& v, const Vector3& along) {
  const double size = along.squaredNorm();
  return size > 0.0 ? Vector3(v - 2.0 * along.dot(v) / size * along) : v;
}

}  // namespace

double curvature(const Vector3& first, const Vector3& second) {
  const double speed = first.norm();
  return speed > 0.0 ? first.cross(second).norm() / (speed * speed * speed) : 0.0;
}

std::optional<double> torsion(const Vector3& first, const Vector3& second, const Vector3& third) {
  const Vector3 across = first.cross(second);
  if (!(across.norm() > kStraight * first.norm() * second.norm())) return std::nullopt;
  return across.dot(third) / across.squaredNorm();
}

std::optional<Triad> frenet(const Vector3& first, const Vector3& second) {
  const Vector3 across = first.cross(second);
  if (!(across.norm() > kStraight * first.norm() * second.norm())) return std::nullopt;
  const Vector3 T = first.normalized();
  const Vector3 B = across.normalized();
  return Triad{T, B.cross(T), B};
}

double discrete_curvature(const Vector3& a, const Vector3& b, const Vector3& c) {
  const Vector3 ab = b - a;
  const Vector3 bc = c - b;
  const double sides = ab.norm() * bc.norm() * (c - a).norm();
  return sides > 0.0 ? 2.0 * ab.cross(bc).norm() / sides : 0.0;
}

std::optional<double> discrete_torsion(const Vector3& a,
                                       const Vector3& b,
                                       const Vector3& c,
                                       const Vector3& d) {
  const auto before = frenet(b - a, c - b);
  const auto after = frenet(c - b, d - c);
  if (!before || !after) return std::nullopt;
  const Vector3 edge = c - b;
  const double angle = angle_between_directions(before->B, after->B);
  return std::copysign(angle, before->B.cross(after->B).dot(edge)) / edge.norm();
}

Triad arbitrary_triad(const Vector3& tangent) {
  Vector3 least = Vector3::Unit(0);
  for (const int axis : {1, 2}) {
    if (std::abs(tangent[axis]) < std::abs(tangent.dot(least))) least = Vector3::Unit(axis);
  }
  const Vector3 N = (least - tangent.dot(least) * tangent).normalized();
  return {tangent, N, tangent.cross(N)};
}

std::vector<Triad> rotation_minimising(std::span<const Vector3> points,
                                       std::span<const Vector3> tangents,
                                       const Triad& start) {
  std::vector<Triad> out{start};
  out.reserve(points.size());
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const Vector3 across = points[i + 1] - points[i];
    const Vector3 N = mirrored(out[i].N, across);
    const Vector3 T = mirrored(out[i].T, across);
    Triad next{tangents[i + 1], mirrored(N, tangents[i + 1] - T), {}};
    // Removes the rounding error that accumulates over a long curve.
    next.N = (next.N - next.T.dot(next.N) * next.T).normalized();
    next.B = next.T.cross(next.N);
    out.push_back(next);
  }
  return out;
}

}  // namespace loopbench::methods::manifold

#include "methods/smoothers/manifold/continuity.hpp"

#include "methods/smoothers/manifold/curvature.hpp"

namespace loopbench::methods::manifold {

Continuity continuity(const ManifoldCurve& curve) {
  constexpr double min_speed_ratio = 1e-3;  // [of the mean speed]
  const std::vector<double>& stamps = curve.stamps();
  Continuity out;
  double length = 0.0;
  Vector3 last = curve.motion(0, stamps.front()).value;
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    const Vector3 current = curve.motion(i - 1, stamps[i]).value;
    length += (current - last).norm();
    last = current;
  }
  const double slowest = min_speed_ratio * length / (stamps.back() - stamps.front());
  for (std::size_t i = 1; i + 1 < stamps.size(); ++i) {
    const MotionJet a = curve.motion(i - 1, stamps[i]);
    const MotionJet b = curve.motion(i, stamps[i]);
    out.position = std::max(out.position, (b.value - a.value).norm());
    out.velocity = std::max(out.velocity, (b.first - a.first).norm());
    out.acceleration = std::max(out.acceleration, (b.second - a.second).norm());
    if (!(a.first.norm() > slowest) || !(b.first.norm() > slowest)) continue;
    out.slope = std::max(out.slope, angle_between_directions(a.first, b.first));
    const Vector3 curvature_jump =
        curvature_vector(b.first, b.second) - curvature_vector(a.first, a.second);
    out.curvature = std::max(out.curvature, curvature_jump.norm());
  }
  return out;
}

}  // namespace loopbench::methods::manifold

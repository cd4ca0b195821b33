#include "methods/smoothers/manifold/moving_frames.hpp"

namespace loopbench::methods::manifold {

CurveFrames moving_frames(const ManifoldCurve& curve) {
  const std::vector<double>& stamps = curve.stamps();
  CurveFrames out;
  std::vector<Vector3> points;
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    const std::size_t edge = i + 1 < stamps.size() ? i : i - 1;
    const MotionJet motion = curve.motion(edge, stamps[i]);
    points.push_back(motion.value);
    out.curvature.push_back(curvature(motion.first, motion.second));
    if (const auto triad = frenet(motion.first, motion.second)) {
      out.triads.push_back(*triad);
      continue;
    }
    ++out.carried;
    const bool is_at_rest = !(motion.first.norm() > 0.0);
    if (i == 0) {
      out.triads.push_back(
          arbitrary_triad(is_at_rest ? Vector3::UnitX() : motion.first.normalized()));
      continue;
    }
    const Triad& before = out.triads.back();
    const Vector3 tangent = is_at_rest ? before.T : Vector3(motion.first.normalized());
    const std::array two{points[i - 1], points[i]};
    out.triads.push_back(rotation_minimising(two, std::array{before.T, tangent}, before).back());
  }
  for (std::size_t i = 0; i + 3 < points.size(); ++i) {
    const auto torsion = discrete_torsion(points[i], points[i + 1], points[i + 2], points[i + 3]);
    if (torsion) out.torsion_max = std::max(out.torsion_max, std::abs(*torsion));
  }
  return out;
}

}  // namespace loopbench::methods::manifold

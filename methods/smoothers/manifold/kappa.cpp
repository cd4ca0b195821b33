#include "methods/smoothers/manifold/kappa.hpp"

#include "methods/smoothers/manifold/curvature.hpp"

namespace loopbench::methods::manifold {
namespace {

Nodes projected(Nodes nodes, const Vector3& up) {
  for (Vector3& point : nodes.points) point -= up.dot(point) * up;
  return nodes;
}

double rotation(const Trajectory& poses, std::size_t i) {
  return 0.5 * angle_between(poses[i - 1].world_from_body.rotation,
                             poses[i + 1].world_from_body.rotation);
}

}  // namespace

std::vector<double> kappas(const Nodes& given,
                           const Trajectory& poses,
                           Kappa definition,
                           CurveSpace plane,
                           const Vector3& up) {
  const Nodes nodes = plane == CurveSpace::plane ? projected(given, up) : given;
  std::vector<double> out(nodes.size(), 0.0);
  std::optional<NodeSpline> spline;
  if (definition == Kappa::analytic_spline) spline.emplace(nodes);
  for (std::size_t i = 1; i + 1 < nodes.size(); ++i) {
    const Vector3 before = nodes.step(i - 1);
    const Vector3 after = nodes.step(i);
    const double angle = angle_between_directions(before, after);
    switch (definition) {
      case Kappa::turn_per_kf:
        out[i] = angle;
        break;
      case Kappa::menger:
        out[i] = discrete_curvature(nodes.points[i - 1], nodes.points[i], nodes.points[i + 1]);
        break;
      case Kappa::dtheta_ds: {
        const double mean_step = 0.5 * (before.norm() + after.norm());
        out[i] = mean_step > 0.0 ? angle / mean_step : 0.0;
        break;
      }
      case Kappa::dtheta_dt:
        out[i] = 2.0 * angle / (nodes.stamps[i + 1] - nodes.stamps[i - 1]);
        break;
      case Kappa::analytic_spline: {
        const MotionJet motion = spline->at(i, time_jet(nodes.stamps[i])).point;
        out[i] = curvature(motion.first, motion.second);
        break;
      }
      case Kappa::rotation_per_kf:
        out[i] = rotation(poses, i);
        break;
    }
  }
  return out;
}

}  // namespace loopbench::methods::manifold

#include <cmath>

#include "datasets/core/factorisations.hpp"
#include "datasets/images/tracking/camera_pose.hpp"

namespace loopbench::rgbd {
namespace {

constexpr int kRefineRounds = 4;
constexpr int kSteps = 6;                   // per round
constexpr double kMinPointDepth = 0.05;     // [m]
constexpr double kChi2[] = {5.991, 7.815};  // 95 % quantiles for 2 and 3 degrees of freedom

/// Whitened difference of pixel and inverse depth (0 if that was not measured), and its Jacobian
/// with respect to the twist e in world_from_camera * exp(e).
struct Residual {
  Vector3 value = Vector3::Zero();
  Eigen::Matrix<double, 3, 6> jacobian = Eigen::Matrix<double, 3, 6>::Zero();
  bool in_front = false;

  double square() const { return value.squaredNorm(); }
};

double bound(const Observation& o) { return kChi2[o.inverse_depth > 0.0 ? 1 : 0]; }

/// Residual of one observation; zero for a point that is not in front of the camera.
Residual residual(const Observation& o, const Camera& camera, const Pose& camera_from_world) {
  Residual out;
  const Vector3 p = camera_from_world * o.in_world;
  if (p.z() < kMinPointDepth) return out;
  out.in_front = true;
  const double iz = 1.0 / p.z();
  const double pixel = 1.0 / (kPixelSigma * o.sigma);
  Matrix3 by_point = Matrix3::Zero();
  by_point.row(0) << camera.fx * iz, 0.0, -camera.fx * p.x() * iz * iz;
  by_point.row(1) << 0.0, camera.fy * iz, -camera.fy * p.y() * iz * iz;
  by_point.topRows<2>() *= pixel;
  out.value.head<2>() = pixel * (camera.project(p) - Eigen::Vector2d(o.u, o.v));
  if (o.inverse_depth > 0.0) {
    const double weight = 1.0 / kInverseDepthSigma;
    out.value.z() = weight * (iz - o.inverse_depth);
    by_point(2, 2) = -weight * iz * iz;
  }
  // The perturbation world_from_camera * exp(e) changes p by -rho + hat(p) phi.
  out.jacobian.leftCols<3>() = -by_point;
  out.jacobian.rightCols<3>() = by_point * hat(p);
  return out;
}

}  // namespace

RefinedPose refine_pose(const std::vector<Observation>& observations,
                        const Camera& camera,
                        const Pose& begin) {
  RefinedPose out{begin, std::vector<bool>(observations.size(), true)};
  for (int round = 0; round < kRefineRounds; ++round) {
    for (int step = 0; step < kSteps; ++step) {
      const Pose camera_from_world = out.world_from_camera.inverse();
      Matrix6 H = Matrix6::Zero();
      Twist g = Twist::Zero();
      for (std::size_t i = 0; i < observations.size(); ++i) {
        if (!out.inlier[i]) continue;
        const Residual r = residual(observations[i], camera, camera_from_world);
        if (!r.in_front) continue;
        const double huber = std::min(1.0, std::sqrt(bound(observations[i]) / r.square()));
        const double weight = std::isfinite(huber) ? huber : 1.0;
        H += weight * r.jacobian.transpose() * r.jacobian;
        g += weight * r.jacobian.transpose() * r.value;
      }
      const Eigen::LDLT<Matrix6> solver(Matrix6(H + 1e-9 * Matrix6::Identity()));
      const Twist e = -solver.solve(g);
      if (!e.allFinite() || e.norm() > 1.0) break;
      out.world_from_camera = normalized(out.world_from_camera * exp_se3(e));
      if (e.norm() < 1e-7) break;
    }
    const Pose camera_from_world = out.world_from_camera.inverse();
    out.inliers = 0;
    out.information.setZero();
    double sum = 0.0;
    double dimension = 0.0;
    for (std::size_t i = 0; i < observations.size(); ++i) {
      const Residual r = residual(observations[i], camera, camera_from_world);
      out.inlier[i] = r.in_front && r.square() < bound(observations[i]);
      if (!out.inlier[i]) continue;
      ++out.inliers;
      out.information += r.jacobian.transpose() * r.jacobian;
      sum += r.square();
      dimension += observations[i].inverse_depth > 0.0 ? 3.0 : 2.0;
    }
    if (out.inliers < 6) {
      out.information.setZero();
      return out;
    }
    out.residual_rms = std::sqrt(sum / std::max(1.0, dimension - 6.0));
  }
  out.information *= kInformationScale / std::max(1.0, out.residual_rms * out.residual_rms);
  out.information = (0.5 * (out.information + out.information.transpose())).eval();
  return out;
}

std::vector<Observation> observations(const std::vector<MapPoint>& points,
                                      const Features& features,
                                      const std::vector<Match>& matches) {
  std::vector<Observation> out;
  out.reserve(matches.size());
  for (const Match& match : matches) {
    const Feature& f = features.points[match.b];
    const double depth = static_cast<double>(f.depth);
    out.push_back({points[match.a].in_world,
                   static_cast<double>(f.u),
                   static_cast<double>(f.v),
                   depth > 0.0 ? 1.0 / depth : 0.0,
                   static_cast<double>(f.sigma)});
  }
  return out;
}

}  // namespace loopbench::rgbd

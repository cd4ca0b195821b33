#include <algorithm>
#include <cmath>

#include "datasets/core/factorisations.hpp"
#include "datasets/images/dense/surface.hpp"
#include "datasets/images/tracking/camera_pose.hpp"

namespace loopbench::rgbd {
namespace {

constexpr int kAlignSteps = 20;
constexpr int kWideSteps = 4;         // number of first steps with the wide gate
constexpr double kWideGate = 0.12;    // maximum distance of associated points [m]
constexpr double kNarrowGate = 0.05;  // the same near the solution [m]
constexpr double kMinCosine = 0.8;    // between associated normals
constexpr double kHuber = 1.5;        // [sigma]
constexpr int kStride = 2;            // subsampling in both image directions [px]

using PlaneRow = Eigen::Matrix<double, 1, 6>;

/// Whitened point-to-plane distance and its Jacobian with respect to the twist.
struct PlaneDistance {
  double value = 0.0;
  PlaneRow jacobian = PlaneRow::Zero();
};

/// Projective association: finds the pixel `index` of `surface` at which a point (in its axes)
/// projects. Returns false if its point is farther than `gate` [m] or its normal differs.
bool associate(const Surface& surface,
               const Vector3& point,
               const Vector3& normal,
               double gate,
               std::size_t& index) {
  if (!(point.z() > 0.05)) return false;
  const Eigen::Vector2d pixel = surface.camera.project(point);
  const auto inside = [](double x, int count) { return x > -0.5 && x < count - 0.5; };
  if (!inside(pixel.x(), surface.camera.width) || !inside(pixel.y(), surface.camera.height)) {
    return false;
  }
  const auto x = static_cast<std::size_t>(std::lround(std::max(0.0, pixel.x())));
  const auto y = static_cast<std::size_t>(std::lround(std::max(0.0, pixel.y())));
  index = y * static_cast<std::size_t>(surface.camera.width) + x;
  const Eigen::Vector3f& n = surface.normals[index];
  return !n.isZero() && n.cast<double>().dot(normal) > kMinCosine &&
         (surface.points[index].cast<double>() - point).squaredNorm() < gate * gate;
}

struct PlaneEquation {
  Matrix6 H = Matrix6::Zero();
  Twist g = Twist::Zero();
  double squares = 0.0;
  double points = 0.0;  ///< number of points used
  double found = 0.0;   ///< number of associated points
};

PlaneEquation plane_equation(const Surface& surface,
                             const std::vector<PlacedSurface>& model,
                             const Pose& world_from_camera,
                             double gate) {
  struct Placed {
    const Surface* surface;
    Matrix3 R;  ///< model_from_camera
    Vector3 t;
  };
  std::vector<Placed> placed;
  for (const PlacedSurface& m : model) {
    const Pose model_from_camera = m.world_from_surface.inverse() * world_from_camera;
    placed.push_back(
        {m.surface, model_from_camera.rotation.toRotationMatrix(), model_from_camera.translation});
  }
  PlaneEquation out;
  std::vector<PlaneDistance> distances;
  const int width = surface.camera.width;
  for (int y = 0; y < surface.camera.height; y += kStride) {
    for (int x = 0; x < width; x += kStride) {
      const auto i = static_cast<std::size_t>(y * width + x);
      if (surface.normals[i].isZero()) continue;
      out.points += 1.0;
      const Vector3 p = surface.points[i].cast<double>();
      const Vector3 normal = surface.normals[i].cast<double>();
      const double sigma = std::sqrt(2.0) * surface.inverse_depth_sigma * p.z() * p.z();
      distances.clear();
      for (const Placed& m : placed) {
        const Vector3 q = m.R * p + m.t;
        std::size_t k = 0;
        if (!associate(*m.surface, q, m.R * normal, gate, k)) continue;
        const Vector3 n = m.surface->normals[k].cast<double>();
        const Vector3 n_here = m.R.transpose() * n;
        PlaneDistance& d = distances.emplace_back();
        d.value = n.dot(q - m.surface->points[k].cast<double>()) / sigma;
        d.jacobian << n_here.transpose() / sigma, p.cross(n_here).transpose() / sigma;
      }
      if (distances.empty()) continue;
      out.found += 1.0;
      for (const PlaneDistance& d : distances) {
        const double huber = std::abs(d.value) < kHuber ? 1.0 : kHuber / std::abs(d.value);
        const double weight = huber / static_cast<double>(distances.size());
        out.H += weight * d.jacobian.transpose() * d.jacobian;
        out.g += weight * d.jacobian.transpose() * d.value;
        out.squares += weight * d.value * d.value;
      }
    }
  }
  return out;
}

}  // namespace

SurfaceAlignment align_surface(const Surface& surface,
                               const std::vector<PlacedSurface>& model,
                               const PriorPose& prior) {
  SurfaceAlignment out;
  out.world_from_camera = prior.world_from_camera;
  for (int step = 0; step < kAlignSteps; ++step) {
    const double gate = step < kWideSteps ? kWideGate : kNarrowGate;
    const PlaneEquation planes = plane_equation(surface, model, out.world_from_camera, gate);
    out.share = planes.found / std::max(1.0, planes.points);
    out.residual_rms = std::sqrt(planes.squares / std::max(1.0, planes.found));
    const double weight = kInformationScale / std::max(1.0, out.residual_rms * out.residual_rms);
    const Twist from_prior = log_se3(prior.world_from_camera.inverse() * out.world_from_camera);
    out.information = weight * planes.H + prior.information;
    const Twist gradient = weight * planes.g + prior.information * from_prior;
    const Twist e = -Matrix6(out.information + 1e-9 * Matrix6::Identity()).ldlt().solve(gradient);
    if (!e.allFinite() || e.norm() > 1.0) break;
    out.world_from_camera = normalized(out.world_from_camera * exp_se3(e));
    if (step > kWideSteps && e.norm() < 1e-5) break;
  }
  out.information = (0.5 * (out.information + out.information.transpose())).eval();
  return out;
}

}  // namespace loopbench::rgbd

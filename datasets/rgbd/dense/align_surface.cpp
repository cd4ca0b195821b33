#include "datasets/rgbd/dense/align_surface.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace loopbench {
namespace {

constexpr int kAlignSteps = 20;
constexpr int kWideSteps = 4;         // of them with the wide gate
constexpr double kWideGate = 0.12;    // farthest that partners lie apart [m]
constexpr double kNarrowGate = 0.05;  // likewise, near the solution [m]
constexpr double kAlike = 0.8;        // least cosine between partners' normals
constexpr double kHuber = 1.5;        // [sigma]
constexpr int kStride = 2;            // pixels and rows between points that are taken

using PlaneRow = Eigen::Matrix<double, 1, 6>;

/// One distance between a point and the plane at its partner, and how the twist moves it.
struct PlaneDistance {
  double value = 0.0;
  PlaneRow jacobian = PlaneRow::Zero();
};

/// The pixel of `surface` that a point in its axes falls on, when it lies there and looks alike.
bool partner(const Surface& surface,
             const Vector3& point,
             const Vector3& normal,
             double gate,
             std::size_t& index) {
  if (!(point.z() > 0.05)) return false;
  const Eigen::Vector2d pixel = surface.camera.project(point);
  const auto inside = [](double at, int count) { return at > -0.5 && at < count - 0.5; };
  if (!inside(pixel.x(), surface.camera.width) || !inside(pixel.y(), surface.camera.height)) {
    return false;
  }
  const auto x = static_cast<std::size_t>(std::lround(std::max(0.0, pixel.x())));
  const auto y = static_cast<std::size_t>(std::lround(std::max(0.0, pixel.y())));
  index = y * static_cast<std::size_t>(surface.camera.width) + x;
  const Eigen::Vector3f& n = surface.normals[index];
  return !n.isZero() && n.cast<double>().dot(normal) > kAlike &&
         (surface.points[index].cast<double>() - point).squaredNorm() < gate * gate;
}

struct PlaneEquation {
  Matrix6 H = Matrix6::Zero();
  Twist g = Twist::Zero();
  double squares = 0.0;
  double points = 0.0;
  double found = 0.0;  ///< of points, with a partner
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
        if (!partner(*m.surface, q, m.R * normal, gate, k)) continue;
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

Alignment align_surface(const Surface& surface,
                        const std::vector<PlacedSurface>& model,
                        const PriorPose& prior,
                        const PoseOptions& options) {
  Alignment out;
  out.world_from_camera = prior.world_from_camera;
  for (int step = 0; step < kAlignSteps; ++step) {
    const double gate = step < kWideSteps ? kWideGate : kNarrowGate;
    const PlaneEquation planes = plane_equation(surface, model, out.world_from_camera, gate);
    out.share = planes.found / std::max(1.0, planes.points);
    out.spread = std::sqrt(planes.squares / std::max(1.0, planes.found));
    const double believed = options.information_scale / std::max(1.0, out.spread * out.spread);
    const Twist from_prior = log_se3(prior.world_from_camera.inverse() * out.world_from_camera);
    out.information = believed * planes.H + prior.information;
    const Twist slope = believed * planes.g + prior.information * from_prior;
    const Twist e =
        -Eigen::LDLT<Matrix6>(out.information + 1e-9 * Matrix6::Identity()).solve(slope);
    if (!e.allFinite() || e.norm() > 1.0) break;
    out.world_from_camera = normalized(out.world_from_camera * exp_se3(e));
    if (step > kWideSteps && e.norm() < 1e-5) break;
  }
  out.information = (0.5 * (out.information + out.information.transpose())).eval();
  return out;
}

}  // namespace loopbench

#include "datasets/rgbd/tracking/focal_check.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

namespace loopbench {
namespace {

constexpr int kFocalRounds = 4;
constexpr std::size_t kFewestToTell = 30;  // matches between two keyframes
constexpr double kSearch = 0.03;           // radius over image width
constexpr double kNotable = 0.05;          // of the factor from 1
constexpr double kSure = 5.0;              // sigmas

/// A match between two keyframes, the first one's with depth.
struct Sight {
  Feature first;
  Feature second;
};

struct SightPair {
  std::vector<Sight> sights;
  Pose first_from_second;
};

Vector3 point_of(const Feature& f, const Camera& camera) {
  return camera.back_project(
      static_cast<double>(f.u), static_cast<double>(f.v), static_cast<double>(f.depth));
}

SightPair sights_between(const Keyframe& a,
                         const Keyframe& b,
                         const Camera& camera,
                         const TrackOptions& options) {
  SightPair out;
  out.first_from_second = a.world_from_camera.inverse() * b.world_from_camera;
  const Features& features = a.features;
  std::vector<Seen> points;
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < features.size(); ++i) {
    const Feature& f = features.points[i];
    if (!(f.depth > 0.0f)) continue;
    points.push_back({point_of(f, camera), f.octave, i});
    rows.push_back(i);
  }
  for (const Match& match : match_near(points,
                                       features,
                                       b.features,
                                       camera,
                                       out.first_from_second,
                                       kSearch * camera.width,
                                       options.match)) {
    out.sights.push_back({features.points[rows[match.a]], b.features.points[match.b]});
  }
  return out;
}

std::vector<Observation> sighted(const SightPair& pair, const Camera& camera) {
  std::vector<Observation> out;
  for (const Sight& s : pair.sights) {
    const double depth = static_cast<double>(s.second.depth);
    out.push_back({point_of(s.first, camera),
                   static_cast<double>(s.second.u),
                   static_cast<double>(s.second.v),
                   depth > 0.0 ? 1.0 / depth : 0.0,
                   static_cast<double>(s.second.sigma)});
  }
  return out;
}

/// The normal equation of the logarithm of the factor: curvature * d = -slope.
struct FactorEquation {
  double curvature = 0.0;
  double slope = 0.0;
};

/// Of one pair, its pose eliminated.
FactorEquation factor_equation(const std::vector<Observation>& observations,
                               const RefinedPose& pose,
                               const Camera& camera,
                               const PoseOptions& options) {
  using Matrix7 = Eigen::Matrix<double, 7, 7>;
  using Vector7 = Eigen::Matrix<double, 7, 1>;
  Matrix7 H = Matrix7::Zero();
  Vector7 g = Vector7::Zero();
  const Pose second_from_first = pose.world_from_camera.inverse();
  const Matrix3 R = second_from_first.rotation.toRotationMatrix();
  for (std::size_t i = 0; i < observations.size(); ++i) {
    if (!pose.inlier[i]) continue;
    const Observation& o = observations[i];
    const Vector3 p = second_from_first * o.in_world;
    const double iz = 1.0 / p.z();
    const double pixel = 1.0 / (options.pixel_sigma * o.sigma);
    const double inverse_depth = o.inverse_depth > 0.0 ? 1.0 / options.inverse_depth_sigma : 0.0;
    Matrix3 by_point = Matrix3::Zero();
    by_point.row(0) << camera.fx * iz, 0.0, -camera.fx * p.x() * iz * iz;
    by_point.row(1) << 0.0, camera.fy * iz, -camera.fy * p.y() * iz * iz;
    by_point.topRows<2>() *= pixel;
    by_point(2, 2) = -inverse_depth * iz * iz;
    const Eigen::Vector2d at = camera.project(p);
    const Vector3 value(
        pixel * (at.x() - o.u), pixel * (at.y() - o.v), inverse_depth * (iz - o.inverse_depth));
    // A longer focal length narrows the cone of points and spreads what they project to.
    const Vector3 narrower = R * Vector3(-o.in_world.x(), -o.in_world.y(), 0.0);
    const Vector3 wider(pixel * (at.x() - camera.cx), pixel * (at.y() - camera.cy), 0.0);
    Eigen::Matrix<double, 3, 7> J;
    J.leftCols<3>() = -by_point;
    J.middleCols<3>(3) = by_point * hat(p);
    J.col(6) = by_point * narrower + wider;
    H += J.transpose() * J;
    g += J.transpose() * value;
  }
  const Eigen::LDLT<Matrix6> of_pose(H.topLeftCorner<6, 6>());
  const Twist coupling = of_pose.solve(H.topRightCorner<6, 1>());
  return {H(6, 6) - coupling.dot(H.topRightCorner<6, 1>()), g(6) - coupling.dot(g.head<6>())};
}

}  // namespace

FocalCheck check_focal(const std::vector<Keyframe>& keyframes,
                       const Camera& camera,
                       const TrackOptions& options) {
  std::vector<SightPair> pairs;
  for (std::size_t k = 1; k < keyframes.size(); ++k) {
    SightPair pair = sights_between(keyframes[k - 1], keyframes[k], camera, options);
    if (pair.sights.size() >= kFewestToTell) pairs.push_back(std::move(pair));
  }
  FocalCheck out;
  out.pairs = pairs.size();
  out.sigma = std::numeric_limits<double>::infinity();
  for (int round = 0; round < kFocalRounds; ++round) {
    Camera now = camera;
    now.fx *= out.factor;
    now.fy *= out.factor;
    FactorEquation sum;
    for (SightPair& pair : pairs) {
      const std::vector<Observation> observations = sighted(pair, now);
      const RefinedPose pose = refine_pose(observations, now, pair.first_from_second, options.pose);
      if (pose.inliers < kFewestToTell / 2) continue;
      pair.first_from_second = pose.world_from_camera;
      const FactorEquation one = factor_equation(observations, pose, now, options.pose);
      const double believed =
          options.pose.information_scale / std::max(1.0, pose.spread * pose.spread);
      sum.curvature += believed * one.curvature;
      sum.slope += believed * one.slope;
    }
    if (!(sum.curvature > 0.0)) return out;
    out.factor *= std::exp(std::clamp(-sum.slope / sum.curvature, -0.2, 0.2));
    out.sigma = out.factor / std::sqrt(sum.curvature);
  }
  return out;
}

std::optional<std::string> focal_warning(const FocalCheck& check, const Camera& camera) {
  const double off = check.factor - 1.0;
  if (std::abs(off) < kNotable || std::abs(off) < kSure * check.sigma) return std::nullopt;
  return fmt::format(
      "images and depth agree better with focal lengths {:.0f} % {} than the camera's ({:.0f} px "
      "instead of {:.0f}): do the intrinsics belong to these images?",
      100.0 * std::abs(off),
      off < 0.0 ? "shorter" : "longer",
      check.factor * camera.fx,
      camera.fx);
}

}  // namespace loopbench

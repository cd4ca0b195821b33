#include "datasets/rgbd/tracking/focal_check.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

namespace loopbench::rgbd {
namespace {

constexpr int kFocalRounds = 4;
constexpr std::size_t kMinPairMatches = 30;  // between two keyframes
constexpr double kSearchRadius = 0.03;       // relative to the image width
constexpr double kMinDeviation = 0.05;       // of the factor from 1 for a warning
constexpr double kSignificance = 5.0;        // [standard deviations]

/// A match between two keyframes; the feature of the first one has depth.
struct MatchedFeatures {
  Feature first;
  Feature second;
};

struct KeyframePair {
  std::vector<MatchedFeatures> matches;
  Pose first_from_second;
};

KeyframePair match_pair(const Keyframe& a, const Keyframe& b, const Camera& camera) {
  KeyframePair out;
  out.first_from_second = a.world_from_camera.inverse() * b.world_from_camera;
  const Features& features = a.features;
  std::vector<MapPoint> points;
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < features.size(); ++i) {
    const Feature& f = features.points[i];
    if (!(f.depth > 0.0f)) continue;
    points.push_back({point_of(f, camera), f.octave, i});
    rows.push_back(i);
  }
  for (const Match& match : match_guided(points,
                                         features,
                                         b.features,
                                         camera,
                                         out.first_from_second,
                                         kSearchRadius * camera.width)) {
    out.matches.push_back({features.points[rows[match.a]], b.features.points[match.b]});
  }
  return out;
}

std::vector<Observation> observations_of(const KeyframePair& pair, const Camera& camera) {
  std::vector<Observation> out;
  for (const MatchedFeatures& s : pair.matches) {
    const double depth = static_cast<double>(s.second.depth);
    out.push_back({point_of(s.first, camera),
                   static_cast<double>(s.second.u),
                   static_cast<double>(s.second.v),
                   depth > 0.0 ? 1.0 / depth : 0.0,
                   static_cast<double>(s.second.sigma)});
  }
  return out;
}

/// Normal equation of the logarithm of the focal length factor: curvature * d = -gradient.
struct FactorEquation {
  double curvature = 0.0;
  double gradient = 0.0;
};

/// Normal equation of one pair with its pose eliminated (Schur complement).
FactorEquation factor_equation(const std::vector<Observation>& observations,
                               const RefinedPose& pose,
                               const Camera& camera) {
  using Matrix7 = Eigen::Matrix<double, 7, 7>;
  using Vector7 = Eigen::Matrix<double, 7, 1>;
  Matrix7 H = Matrix7::Zero();
  Vector7 g = Vector7::Zero();
  const Pose second_from_first = pose.world_from_camera.inverse();
  const Matrix3 R = second_from_first.rotation.toRotationMatrix();
  for (std::size_t i = 0; i < observations.size(); ++i) {
    if (!pose.inlier[i]) continue;
    const Observation& o = observations[i];
    const Residual r = residual(o, camera, second_from_first);
    const Matrix3 by_point = -r.jacobian.leftCols<3>();
    const double pixel = 1.0 / (kPixelSigma * o.sigma);
    const Eigen::Vector2d at = camera.project(second_from_first * o.in_world);
    // A longer focal length moves the point towards the optical axis and scales its projection.
    const Vector3 by_depth_point = R * Vector3(-o.in_world.x(), -o.in_world.y(), 0.0);
    const Vector3 by_projection(pixel * (at.x() - camera.cx), pixel * (at.y() - camera.cy), 0.0);
    Eigen::Matrix<double, 3, 7> J;
    J.leftCols<6>() = r.jacobian;
    J.col(6) = by_point * by_depth_point + by_projection;
    H += J.transpose() * J;
    g += J.transpose() * r.value;
  }
  const Eigen::LDLT<Matrix6> pose_block(H.topLeftCorner<6, 6>());
  const Twist coupling = pose_block.solve(H.topRightCorner<6, 1>());
  return {H(6, 6) - coupling.dot(H.topRightCorner<6, 1>()), g(6) - coupling.dot(g.head<6>())};
}

}  // namespace

FocalCheck check_focal(const std::vector<Keyframe>& keyframes, const Camera& camera) {
  std::vector<KeyframePair> pairs;
  for (std::size_t k = 1; k < keyframes.size(); ++k) {
    KeyframePair pair = match_pair(keyframes[k - 1], keyframes[k], camera);
    if (pair.matches.size() >= kMinPairMatches) pairs.push_back(std::move(pair));
  }
  FocalCheck out;
  out.pairs = pairs.size();
  out.sigma = std::numeric_limits<double>::infinity();
  for (int round = 0; round < kFocalRounds; ++round) {
    Camera scaled = camera;
    scaled.fx *= out.factor;
    scaled.fy *= out.factor;
    FactorEquation sum;
    for (KeyframePair& pair : pairs) {
      const std::vector<Observation> observations = observations_of(pair, scaled);
      const RefinedPose pose = refine_pose(observations, scaled, pair.first_from_second);
      if (pose.inliers < kMinPairMatches / 2) continue;
      pair.first_from_second = pose.world_from_camera;
      const FactorEquation equation = factor_equation(observations, pose, scaled);
      const double weight =
          kInformationScale / std::max(1.0, pose.residual_rms * pose.residual_rms);
      sum.curvature += weight * equation.curvature;
      sum.gradient += weight * equation.gradient;
    }
    if (!(sum.curvature > 0.0)) return out;
    out.factor *= std::exp(std::clamp(-sum.gradient / sum.curvature, -0.2, 0.2));
    out.sigma = out.factor / std::sqrt(sum.curvature);
  }
  return out;
}

std::optional<std::string> focal_warning(const FocalCheck& check, const Camera& camera) {
  const double deviation = check.factor - 1.0;
  if (std::abs(deviation) < kMinDeviation || std::abs(deviation) < kSignificance * check.sigma)
    return std::nullopt;
  return fmt::format(
      "images and depth agree better with focal lengths {:.0f} % {} than the camera's ({:.0f} px "
      "instead of {:.0f}): do the intrinsics belong to these images?",
      100.0 * std::abs(deviation),
      deviation < 0.0 ? "shorter" : "longer",
      check.factor * camera.fx,
      camera.fx);
}

}  // namespace loopbench::rgbd

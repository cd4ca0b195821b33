#include "methods/correctors/gravity.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "methods/correctors/chain.hpp"
#include "methods/correctors/chi_squared.hpp"

namespace loopbench::methods {
namespace {

/// The rotation about z in q = Rz T, where T has none.
Rotation about_z(const Rotation& q) { return exp_so3({0.0, 0.0, 2.0 * std::atan2(q.z(), q.w())}); }

}  // namespace

std::string gravity_fault(const Problem& problem) {
  if (!has_scale_drift(problem)) return "";
  return "edges change the scale, but gravity holds the roll and pitch of rigid poses";
}

LevelledProblem::LevelledProblem(const Problem& problem) : levelled_(problem) {
  tilts_.reserve(problem.keyframes.size());
  for (StampedPose& keyframe : levelled_.keyframes) {
    Rotation& rotation = keyframe.world_from_body.rotation;
    const Rotation yaw = about_z(rotation);
    tilts_.push_back((yaw.conjugate() * rotation).normalized());
    rotation = yaw;
  }
  Eigen::Vector2d tilt;
  for (Edge& edge : levelled_.odometry) edge = levelled(edge, tilt);
  for (Edge& edge : levelled_.closures) {
    edge = levelled(edge, tilt);
    const Eigen::Matrix2d covariance = inverse_of(edge.information).block<2, 2>(3, 3);
    squared_tilt_ += tilt.squaredNorm();
    squared_stated_ += covariance.trace();
    chi2_ += tilt.dot(covariance.llt().solve(tilt));
  }
  for (Anchor& anchor : levelled_.anchors) {
    anchor.point_in_body = tilts_[anchor.keyframe] * anchor.point_in_body;
  }
}

/// With Z' = T_i Z T_j^-1 and its error Ad(T_j) e. Z' = P S with P in the group and a tilt S =
/// Exp(s) that the keyframes exclude. For P Exp(f) the error is about f - s, least for the other
/// components of f at Omega_ff^-1 Omega_fs s.
Edge LevelledProblem::levelled(const Edge& edge, Eigen::Vector2d& tilt) const {
  constexpr int kFree[] = {0, 1, 2, 5}, kHeld[] = {3, 4};
  Edge out = edge;
  const Rotation& from = tilts_[edge.from];
  const Rotation& to = tilts_[edge.to];
  const Rotation turned = (from * edge.from_from_to.rotation * to.conjugate()).normalized();
  const Rotation yaw = about_z(turned);
  tilt = log_so3(yaw.conjugate() * turned).head<2>();
  Matrix6 axes = Matrix6::Zero();
  axes.topLeftCorner<3, 3>() = axes.bottomRightCorner<3, 3>() = to.toRotationMatrix();
  const Matrix6 information = axes * edge.information * axes.transpose();
  out.information = 0.5 * (information + information.transpose());
  Eigen::Matrix4d free;
  Eigen::Matrix<double, 4, 2> coupled;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) free(i, j) = out.information(kFree[i], kFree[j]);
    for (int j = 0; j < 2; ++j) coupled(i, j) = out.information(kFree[i], kHeld[j]);
  }
  const Eigen::Vector4d moved = free.llt().solve(coupled * tilt);
  const Pose level{yaw, from * edge.from_from_to.translation};
  out.from_from_to = normalized(level * exp_se3(twist(moved.head<3>(), {0.0, 0.0, moved[3]})));
  return out;
}

Trajectory LevelledProblem::tilted(Trajectory levelled) const {
  for (std::size_t i = 0; i < levelled.size(); ++i) {
    Pose& pose = levelled[i].world_from_body;
    pose.rotation = (pose.rotation * tilts_[i]).normalized();
  }
  return levelled;
}

void LevelledProblem::report_tilt(Report& report) const {
  constexpr double kFar = 9.0, kDegrees = 180.0 / M_PI;
  const std::size_t closures = levelled_.closures.size();
  if (closures == 0) return;
  const auto count = static_cast<double>(closures);
  const double rms = kDegrees * std::sqrt(squared_tilt_ / count);
  report.count("tilt_error", rms);
  const std::size_t dof = 2 * closures;
  if (!is_unlikely(chi2_, dof) || chi2_ < kFar * static_cast<double>(dof)) return;
  report.notes.push_back(fmt::format(
      "the closures differ from the held roll and pitch by {:.2g} degrees (rms), their deviations "
      "are {:.2g}: roll and pitch are not as accurate as gravity states, or the z axis of the "
      "world is not vertical",
      rms,
      kDegrees * std::sqrt(squared_stated_ / count)));
}

}  // namespace loopbench::methods

#include "methods/correctors/anchors.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "datasets/core/align_points.hpp"
#include "methods/correctors/chain.hpp"
#include "methods/correctors/shares.hpp"

namespace loopbench::methods {
namespace {

/// The anchor without the component along z of the pose.
Anchor in_plane(const Pose& plane, Anchor anchor) {
  const Matrix3 R = plane.rotation.toRotationMatrix();
  Vector3 local = plane.inverse() * anchor.position;
  Matrix3 covariance = R.transpose() * anchor.covariance * R;
  local.z() = anchor.point_in_body.z() = 0.0;
  covariance.row(2).head<2>().setZero();
  covariance.col(2).head<2>().setZero();
  anchor.position = plane * local;
  anchor.covariance = R * covariance * R.transpose();
  return anchor;
}

/// Whether the anchors are away from a line (in the plane: from a point; if level: from a vertical
/// line) by more than their errors.
bool determine_frame(const std::vector<Anchor>& anchors, bool planar, bool level) {
  constexpr double kClear = 3.0;
  const auto count = static_cast<double>(anchors.size());
  Vector3 mean = Vector3::Zero();
  double variance = 0.0;
  for (const Anchor& anchor : anchors) {
    mean += anchor.position / count;
    variance += anchor.covariance.trace() / 3.0 / count;
  }
  Matrix3 scatter = Matrix3::Zero();
  for (const Anchor& anchor : anchors) {
    Vector3 d = anchor.position - mean;
    if (level) d.z() = 0.0;
    scatter += d * d.transpose() / count;
  }
  const Vector3 ascending = Eigen::SelfAdjointEigenSolver<Matrix3>(scatter).eigenvalues();
  return (planar || level ? ascending[2] : ascending[1]) > kClear * kClear * variance;
}

struct Target {
  std::size_t keyframe;
  Vector3 shift;
};

/// Shifts after which the anchors' errors are zero, in the order of the keyframes.
std::vector<Target> targets_of(const Trajectory& poses, const std::vector<Anchor>& anchors) {
  std::vector<Target> out;
  for (std::size_t i = 0; i < anchors.size();) {
    const std::size_t keyframe = anchors[i].keyframe;
    Matrix3 information = Matrix3::Zero();
    Vector3 weighted = Vector3::Zero();
    for (; i < anchors.size() && anchors[i].keyframe == keyframe; ++i) {
      const Matrix3 each = anchors[i].covariance.inverse();
      information += each;
      weighted -= each * anchor_error(anchors[i], poses[keyframe].world_from_body);
    }
    out.push_back({keyframe, information.llt().solve(weighted)});
  }
  return out;
}

}  // namespace

std::string anchors_fault(const Problem& problem) {
  if (problem.anchors.empty() || !has_scale_drift(problem)) return "";
  return "anchors require edges of scale 1, but edges change the scale";
}

UsedAnchors::UsedAnchors(const Problem& problem, bool is_level)
    : anchors(problem.anchors), planar(problem.planar), level(is_level) {
  if (anchors.empty()) return;
  for (Anchor& anchor : anchors) {
    if (planar) anchor = in_plane(problem.keyframes.front().world_from_body, anchor);
  }
  is_first_free = determine_frame(anchors, planar, level);
  if (!is_first_free) std::erase_if(anchors, [](const Anchor& a) { return a.keyframe == 0; });
}

Pose UsedAnchors::alignment(const Trajectory& poses) const {
  if (!is_first_free) return {};
  const Pose& first = poses.front().world_from_body;
  const auto count = static_cast<Eigen::Index>(anchors.size());
  Eigen::Matrix3Xd from(3, count), to(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Anchor& anchor = anchors[static_cast<std::size_t>(i)];
    const Pose& at = poses[anchor.keyframe].world_from_body;
    from.col(i) = first.inverse() * (at * anchor.point_in_body);
    to.col(i) = first.inverse() * anchor.position;
  }
  Matrix3 R = Matrix3::Identity();
  Vector3 t = Vector3::Zero();
  if (planar || level) {
    const Eigen::Matrix2Xd here = from.topRows<2>(), there = to.topRows<2>();
    const Matrix3 motion = align_points(here, there, false);
    R.topLeftCorner<2, 2>() = motion.topLeftCorner<2, 2>();
    t.head<2>() = motion.topRightCorner<2, 1>();
    if (level) t.z() = (to.row(2) - from.row(2)).mean();
  } else {
    const Eigen::Matrix4d motion = align_points(from, to, false);
    R = motion.topLeftCorner<3, 3>();
    t = motion.topRightCorner<3, 1>();
  }
  return normalized(first * Pose{Rotation(R), t} * first.inverse());
}

std::size_t UsedAnchors::degrees_of_freedom() const {
  const std::size_t coordinates = (planar ? 2 : 3) * anchors.size();
  if (!is_first_free) return coordinates;
  if (level) return coordinates - 4;
  return coordinates - (planar ? 3 : 6);
}

void UsedAnchors::report_held_pose(Report& report) const {
  if (anchors.empty() || is_first_free) return;
  report.notes.push_back(
      std::string("the first keyframe is held, because the anchors do not determine the frame: ") +
      (planar || level ? "two at different positions do" : "three that are not on a line do"));
}

void distribute_anchor_errors(Trajectory& poses,
                              const Problem& problem,
                              const std::vector<double>& shares,
                              Report& report) {
  const UsedAnchors used(problem);
  if (used.anchors.empty()) return;
  used.report_held_pose(report);
  const Pose motion = used.alignment(poses);
  for (StampedPose& each : poses) each.world_from_body = normalized(motion * each.world_from_body);
  std::vector<Target> targets = targets_of(poses, used.anchors);
  Target before{0, used.is_first_free ? targets.front().shift : Vector3(Vector3::Zero())};
  poses.front().world_from_body.translation += before.shift;
  targets.push_back({poses.size() - 1, targets.back().shift});
  const std::vector<bool> frozen(poses.size(), false);
  for (const Target& next : targets) {
    if (next.keyframe <= before.keyframe) continue;
    const auto along = loop_shares(shares, frozen, {before.keyframe, next.keyframe, {}});
    for (std::size_t k = 0; k < along->cumulative.size(); ++k) {
      poses[before.keyframe + 1 + k].world_from_body.translation +=
          before.shift + along->cumulative[k] * (next.shift - before.shift);
    }
    before = next;
  }
  double largest = 0.0;
  for (const Anchor& anchor : used.anchors) {
    const Pose& at = poses[anchor.keyframe].world_from_body;
    largest = std::max(largest, anchor_error(anchor, at).norm());
  }
  report.count("largest_anchor_error", largest);
}

}  // namespace loopbench::methods

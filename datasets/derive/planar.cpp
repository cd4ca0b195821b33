#include "datasets/derive/planar.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace loopbench {
namespace {

std::string axis_text(const Vector3& normal) {
  for (const int axis : {0, 1, 2}) {
    if (normal == Vector3::Unit(axis)) return std::string(1, "xyz"[axis]);
  }
  return fmt::format("({:.3g}, {:.3g}, {:.3g})", normal.x(), normal.y(), normal.z());
}

std::string listed(const std::vector<std::string>& names) {
  std::string out;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) out += i + 1 < names.size() ? ", " : " and ";
    out += names[i];
  }
  return out;
}

/// The plane of a list in a body with this normal; the normal of positions is one of the world.
std::optional<MotionPlane> own_plane(const Trajectory& poses, const Vector3& normal) {
  if (lacks_rotations(poses)) return motion_plane(poses);
  return poses.empty() ? std::nullopt : plane_with(poses, normal);
}

bool is_identity(const Rotation& rotation) {
  return rotation.coeffs() == Rotation::Identity().coeffs();
}

/// What moves to the plane, with the largest distance and rotation.
struct Moved {
  double metres = 0.0, radians = 0.0;

  void operator()(Pose& pose, const MotionPlane& plane, const Vector3& origin) {
    const Pose flat = moved_to_plane(pose, plane, origin);
    metres = std::max(metres, (flat.translation - pose.translation).norm());
    if (has_rotation(pose)) {
      radians = std::max(radians, angle_between(flat.rotation, pose.rotation));
    }
    pose = flat;
  }
};

PlanarChoice moved_to_planes(const PlanarParts& parts) {
  const MotionPlane plane = nearest_plane(*parts.trajectories.front().poses);
  Moved move;
  for (const auto& [name, poses] : parts.trajectories) {
    if (poses->empty()) continue;
    const MotionPlane own = nearest_plane(*poses, plane.in_body);
    const Vector3 origin = poses->front().world_from_body.translation;
    for (auto& [stamp, pose] : *poses) move(pose, own, origin);
  }
  for (Pose* pose : parts.measurements) {
    move(*pose, {plane.in_body, plane.in_body}, Vector3::Zero());
  }
  return {
      true,
      plane.in_body,
      fmt::format("planar, as set: poses and closures were moved to the plane with normal {} of "
                  "the body, by up to {:.3g} m and {:.3g} deg",
                  axis_text(plane.in_body),
                  move.metres,
                  std::round(1e6 * move.radians * 180.0 / std::numbers::pi) / 1e6)};
}

}  // namespace

PlanarChoice choose_planar(Planar wanted, const PlanarParts& parts) {
  if (wanted == Planar::no || parts.trajectories.front().poses->empty()) return {};
  if (wanted == Planar::yes) return moved_to_planes(parts);
  const auto plane = motion_plane(*parts.trajectories.front().poses);
  std::vector<std::string> in_plane, others;
  for (const auto& [name, poses] : parts.trajectories) {
    if (poses->empty()) continue;
    const auto found = plane ? own_plane(*poses, plane->in_body) : motion_plane(*poses);
    (found ? in_plane : others).push_back(name);
  }
  if (in_plane.empty()) return {};
  if (plane && !parts.measurements.empty()) {
    const MotionPlane kept{plane->in_body, plane->in_body};
    const bool is_kept = std::ranges::all_of(parts.measurements, [&](const Pose* pose) {
      return is_in_plane(*pose, kept, Vector3::Zero());
    });
    (is_kept ? in_plane : others).emplace_back("closures");
  }
  if (!others.empty()) {
    return {false,
            Vector3::UnitZ(),
            fmt::format("spatial: {} in one plane, but {} not (planar: yes moves them to it)",
                        listed(in_plane) + (in_plane.size() == 1 ? " is" : " are"),
                        listed(others))};
  }
  return {true,
          plane->in_body,
          fmt::format("planar: {} in one plane, with normal {} of the body, so poses are corrected "
                      "in x, y and yaw (planar: no corrects all six)",
                      listed(in_plane) + (in_plane.size() == 1 ? " is" : " are"),
                      axis_text(plane->in_body))};
}

void change_body(Trajectory& poses, const Rotation& body_from_new) {
  if (is_identity(body_from_new) || lacks_rotations(poses)) return;
  for (auto& [stamp, pose] : poses) pose.rotation = (pose.rotation * body_from_new).normalized();
}

void change_body(Problem& problem, const Rotation& body_from_new) {
  if (is_identity(body_from_new)) return;
  change_body(problem.keyframes, body_from_new);
  change_body(problem.frames, body_from_new);
  const Pose change{body_from_new, Vector3::Zero()};
  const Matrix6 of_twist = adjoint(change);
  for (std::vector<Edge>* const edges : {&problem.odometry, &problem.closures}) {
    for (Edge& edge : *edges) {
      edge.from_from_to = normalized(change.inverse() * edge.from_from_to * change);
      const Matrix6 information = of_twist.transpose() * edge.information * of_twist;
      edge.information = 0.5 * (information + information.transpose());
    }
  }
  for (Anchor& anchor : problem.anchors) {
    anchor.point_in_body = body_from_new.conjugate() * anchor.point_in_body;
  }
}

void set_body(Sequence& sequence, const Rotation& body_from_new) {
  change_body(sequence.problem, body_from_new);
  change_body(sequence.reference, body_from_new);
  Provenance& provenance = sequence.provenance;
  provenance.file_body_from_body.rotation = body_from_new;
  if (!provenance.body_from_reference) return;
  *provenance.body_from_reference =
      Pose{body_from_new.conjugate(), Vector3::Zero()} * *provenance.body_from_reference;
}

}  // namespace loopbench

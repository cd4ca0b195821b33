/// Extrinsic offset of a reference whose poses are of another body than the estimate's: a marker,
/// an IMU or another camera.
#pragma once

#include <algorithm>

#include "datasets/core/fields.hpp"
#include "datasets/core/trajectory.hpp"

namespace loopbench {

/// Extrinsic offset body_from_reference: pose of the reference's body in the frame of the
/// estimate's body, in the order of TUM files. The default is the identity (same body).
struct ReferenceBody {
  double x = 0.0;  ///< [m]
  double y = 0.0;
  double z = 0.0;
  double qx = 0.0;
  double qy = 0.0;
  double qz = 0.0;
  double qw = 1.0;
};

template <class Visit>
void reference_body_fields(ReferenceBody& o, Visit visit) {
  const Between unit{-1.0, 1.0};
  visit("reference_body.x",
        o.x,
        "x of the reference's body in the frame of the estimate's body [m]",
        Between{-1e6, 1e6});
  visit("reference_body.y",
        o.y,
        "y of the reference's body in the frame of the estimate's body [m]",
        Between{-1e6, 1e6});
  visit("reference_body.z",
        o.z,
        "z of the reference's body in the frame of the estimate's body [m]",
        Between{-1e6, 1e6});
  visit("reference_body.qx",
        o.qx,
        "x of the unit quaternion of the reference's body in the frame of the estimate's body [-]",
        unit);
  visit("reference_body.qy", o.qy, "y of the unit quaternion, see reference_body.qx [-]", unit);
  visit("reference_body.qz", o.qz, "z of the unit quaternion, see reference_body.qx [-]", unit);
  visit("reference_body.qw", o.qw, "w of the unit quaternion, see reference_body.qx [-]", unit);
}

inline constexpr double kNormTolerance = 1e-2;  // the same as for quaternions in files

/// Returns body_from_reference. Throws OptionError if the norm of the quaternion differs from 1 by
/// more than 0.01.
inline Pose pose_of(const ReferenceBody& body) {
  const Pose out{{body.qw, body.qx, body.qy, body.qz}, {body.x, body.y, body.z}};
  const double norm = out.rotation.norm();
  if (!(std::abs(norm - 1.0) <= kNormTolerance)) {
    throw OptionError("reference_body.qw",
                      "reference_body: qx, qy, qz, qw have norm " + to_text(norm) +
                          ", expected a unit quaternion");
  }
  return normalized(out);
}

/// Whether the offset is not the identity.
inline bool has_offset(const ReferenceBody& body) {
  const double parts[] = {body.x, body.y, body.z, body.qx, body.qy, body.qz};
  return std::ranges::any_of(parts, [](double part) { return part != 0.0; });
}

/// Converts the reference to poses of the estimate's body: world_from_reference *
/// body_from_reference^-1. The reference is returned unchanged if the offset is the identity.
/// Positions without rotation stay where they are, and to_reference_body() moves the estimate.
/// Throws OptionError like pose_of(). O(n).
inline Trajectory to_estimate_body(Trajectory reference, const ReferenceBody& body) {
  const Pose reference_from_body = pose_of(body).inverse();
  if (!has_offset(body) || lacks_rotations(reference)) return reference;
  for (auto& [stamp, world_from_body] : reference) {
    world_from_body = normalized(world_from_body * reference_from_body);
  }
  return reference;
}

/// Converts an estimate to poses of the reference's body: world_from_body * body_from_reference.
/// Throws OptionError like pose_of(). O(n).
inline Trajectory to_reference_body(Trajectory estimate, const ReferenceBody& body) {
  const Pose body_from_reference = pose_of(body);
  if (!has_offset(body)) return estimate;
  for (auto& [stamp, world_from_body] : estimate) {
    world_from_body = normalized(world_from_body * body_from_reference);
  }
  return estimate;
}

}  // namespace loopbench

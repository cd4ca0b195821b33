#include "datasets/derive/reference_body.hpp"

#include <algorithm>

namespace loopbench {
namespace {

constexpr double kNormTolerance = 1e-2;  // the same as for quaternions in files

}  // namespace

Pose pose_of(const ReferenceBody& body) {
  const Pose out{{body.qw, body.qx, body.qy, body.qz}, {body.x, body.y, body.z}};
  const double norm = out.rotation.norm();
  if (!(std::abs(norm - 1.0) <= kNormTolerance)) {
    throw OptionError("reference_body.qw",
                      "reference_body: qx, qy, qz, qw have norm " + to_text(norm) +
                          ", expected a unit quaternion");
  }
  return normalized(out);
}

bool has_offset(const ReferenceBody& body) {
  const double parts[] = {body.x, body.y, body.z, body.qx, body.qy, body.qz};
  return std::ranges::any_of(parts, [](double part) { return part != 0.0; });
}

Trajectory to_estimate_body(Trajectory reference, const ReferenceBody& body) {
  const Pose reference_from_body = pose_of(body).inverse();
  if (!has_offset(body) || lacks_rotations(reference)) return reference;
  for (auto& [stamp, world_from_body] : reference) {
    world_from_body = normalized(world_from_body * reference_from_body);
  }
  return reference;
}

Trajectory to_reference_body(Trajectory estimate, const ReferenceBody& body) {
  const Pose body_from_reference = pose_of(body);
  if (!has_offset(body)) return estimate;
  for (auto& [stamp, world_from_body] : estimate) {
    world_from_body = normalized(world_from_body * body_from_reference);
  }
  return estimate;
}

}  // namespace loopbench

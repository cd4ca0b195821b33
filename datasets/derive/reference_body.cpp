#include "datasets/derive/reference_body.hpp"

namespace loopbench {
namespace {

constexpr double kUnit = 1e-2;  // as in files

}  // namespace

Trajectory of_estimate_body(Trajectory reference, const ReferenceBody& body) {
  const Pose body_from_reference{{body.qw, body.qx, body.qy, body.qz}, {body.x, body.y, body.z}};
  const double norm = body_from_reference.rotation.norm();
  if (!(std::abs(norm - 1.0) <= kUnit)) {
    throw OptionError("reference_body.qw",
                      "reference_body: qx, qy, qz, qw have norm " + to_text(norm) +
                          ", expected a unit quaternion");
  }
  const Pose reference_from_body = normalized(body_from_reference).inverse();
  const bool is_same =
      reference_from_body.translation.isZero(0.0) && reference_from_body.rotation.vec().isZero(0.0);
  if (is_same) return reference;
  for (auto& [stamp, world_from_body] : reference) {
    world_from_body = normalized(world_from_body * reference_from_body);
  }
  return reference;
}

}  // namespace loopbench

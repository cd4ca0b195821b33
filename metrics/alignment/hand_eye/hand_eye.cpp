#include "metrics/alignment/hand_eye/hand_eye.hpp"

#include "metrics/alignment/hand_eye/lever_arm_fit.hpp"
#include "metrics/alignment/hand_eye/rotation_fit.hpp"

namespace loopbench::metrics {

HandEye hand_eye(const std::vector<RelativePosePair>& pairs) {
  const RotationFit rotation = fit_rotation(pairs);
  std::vector<LeverArmEquation> equations;
  equations.reserve(pairs.size());
  for (const auto& [q, z] : pairs) {
    const Vector3 translation = rotation.body_from_reference * q.translation;
    equations.push_back({z.rotation.toRotationMatrix() - Matrix3::Identity(),
                         translation,
                         translation - z.translation});
  }
  const LeverArmFit lever_arm = fit_lever_arm(std::move(equations));
  return {{rotation.body_from_reference, lever_arm.lever_arm},
          lever_arm.deviation,
          rotation.explained,
          lever_arm.explained};
}

}  // namespace loopbench::metrics

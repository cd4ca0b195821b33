#include "metrics/alignment/hand_eye/hand_eye.hpp"

#include "metrics/alignment/hand_eye/lever_fit.hpp"
#include "metrics/alignment/hand_eye/turn_fit.hpp"

namespace loopbench::metrics {

HandEye hand_eye(const std::vector<MotionPair>& pairs) {
  const TurnFit turn = fit_turn(pairs);
  std::vector<LeverEquation> equations;
  equations.reserve(pairs.size());
  for (const auto& [q, z] : pairs) {
    const Vector3 way = turn.body_from_reference * q.translation;
    equations.push_back(
        {z.rotation.toRotationMatrix() - Matrix3::Identity(), way, way - z.translation});
  }
  const LeverFit place = fit_lever(std::move(equations));
  return {
      {turn.body_from_reference, place.lever}, place.deviation, turn.explained, place.explained};
}

}  // namespace loopbench::metrics

#include "metrics/ate.hpp"

#include "metrics/angle.hpp"

namespace loopbench {

std::vector<Score> ate(const Evaluation& evaluation, const AteOptions&) {
  const std::size_t n = evaluation.reference.size();
  std::vector<double> metres(n);
  std::vector<double> degrees(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Pose& reference = evaluation.reference[i].world_from_body;
    const Pose& estimate = evaluation.estimate[i].world_from_body;
    metres[i] = (reference.translation - estimate.translation).norm();
    degrees[i] = kDegrees * angle_between(estimate.rotation, reference.rotation);
  }
  return {{"translation", "3d", "m", statistics(std::move(metres), evaluation.protocol.ddof)},
          {"rotation", "3d", "deg", statistics(std::move(degrees), evaluation.protocol.ddof)}};
}

}  // namespace loopbench

#include "metrics/correction/local_shape.hpp"

#include <stdexcept>

#include "metrics/numerics/angle.hpp"

namespace loopbench::metrics {

std::vector<Score> local_shape(const Evaluation& evaluation, const LocalShapeOptions&) {
  const Trajectory& before =
      needed(evaluation.context.problem, "local_shape", "keyframes before correction").keyframes;
  const Trajectory& after = needed(evaluation.context.estimate, "local_shape", "keyframes");
  if (before.size() < 2) throw Undefined("local_shape: needs at least two keyframes");
  std::vector<double> metres;
  std::vector<double> degrees;
  const auto step = [](const Trajectory& poses, std::size_t i) {
    return poses.at(i).world_from_body.inverse() * poses.at(i + 1).world_from_body;
  };
  for (std::size_t i = 0; i + 1 < before.size(); ++i) {
    const Pose E = step(before, i).inverse() * step(after, i);
    metres.push_back(E.translation.norm());
    degrees.push_back(kDegrees * log_so3(E.rotation).norm());
  }
  const int ddof = evaluation.protocol.ddof;
  // Not directed: the change is relative to the uncorrected keyframes, not to the reference.
  return descriptions({{"translation", "3d", "m", statistics(std::move(metres), ddof)},
                       {"rotation", "3d", "deg", statistics(std::move(degrees), ddof)}});
}

}  // namespace loopbench::metrics

#include "metrics/correction/closure_residual.hpp"

#include <cmath>

#include "metrics/numerics/angle.hpp"

namespace loopbench::metrics {

std::vector<Score> closure_residual(const Evaluation& evaluation) {
  const Problem& problem = needed(evaluation.context.problem, "closure_residual", "loop closures");
  const Trajectory& poses = needed(evaluation.context.estimate, "closure_residual", "keyframes");
  if (problem.closures.empty()) {
    throw Undefined("closure_residual: needs loop closures; the sequence has none");
  }
  std::vector<double> metres;
  std::vector<double> degrees;
  std::vector<double> mahalanobis;
  for (const Edge& edge : problem.closures) {
    if (edge.scale != 1.0) {
      throw Undefined("closure_residual: a closure changes the scale (factor " +
                      to_text(edge.scale) + "), so its residual is not in metres");
    }
    const Pose from_from_to =
        poses.at(edge.from).world_from_body.inverse() * poses.at(edge.to).world_from_body;
    const Pose E = normalized(edge.from_from_to.inverse() * from_from_to);
    const Twist e = log_se3(E);
    metres.push_back(E.translation.norm());
    degrees.push_back(kDegrees * log_so3(E.rotation).norm());
    mahalanobis.push_back(std::sqrt(e.dot(edge.information * e)));
  }
  const int ddof = evaluation.protocol.ddof;
  // Not directed: closures taken as exact have zero residual, even false ones.
  return descriptions({{"translation", "3d", "m", statistics(std::move(metres), ddof)},
                       {"rotation", "3d", "deg", statistics(std::move(degrees), ddof)},
                       {"mahalanobis", "3d", "1", statistics(std::move(mahalanobis), ddof)}});
}

}  // namespace loopbench::metrics

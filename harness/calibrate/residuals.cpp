#include "harness/calibrate/residuals.hpp"

#include "datasets/derive/poses_at.hpp"
#include "methods/correctors/chain.hpp"
#include "metrics/trajectory/position_only.hpp"

namespace loopbench::harness {

CalibrationResiduals residuals(const Sequence& sequence,
                               const std::string& label,
                               std::size_t every) {
  const Problem& problem = sequence.problem;
  if (sequence.reference.empty())
    throw InputError(label + ": has no reference for the calibration");
  if (const std::string fault = methods::chain_fault(problem); !fault.empty()) {
    throw InputError(label + ": " + fault);
  }
  if (metrics::is_position_only(sequence.reference)) {
    throw InputError(label + ": the reference has only positions, expected orientations as well");
  }
  const auto truth = poses_at(sequence.reference, stamps(problem.keyframes), InterpolationLimits{});
  const std::vector<methods::EdgeMotion> moved = methods::motions(problem);
  CalibrationResiduals out{label, problem.planar, {}};
  for (std::size_t begin = 0; begin + every <= moved.size(); begin += every) {
    const std::size_t end = begin + every;
    if (!truth[begin] || !truth[end]) continue;
    EdgeError edge;
    Pose measured;
    for (std::size_t i = begin; i < end; ++i) {
      measured = normalized(measured * problem.odometry[i].from_from_to);
      for (const methods::Regressor regressor : methods::kRegressors) {
        edge.regressors[static_cast<std::size_t>(regressor)] +=
            methods::regressor_value(regressor, moved[i]);
      }
    }
    edge.error = log_se3(measured.inverse() * (truth[begin]->inverse() * *truth[end]));
    out.edges.push_back(edge);
  }
  return out;
}

}  // namespace loopbench::harness

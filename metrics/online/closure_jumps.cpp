#include "metrics/online/closure_jumps.hpp"

#include "metrics/numerics/angle.hpp"
#include "metrics/online/replay_of.hpp"

namespace loopbench::metrics {

std::vector<Score> closure_jumps(const Evaluation& evaluation, const NoOptions&) {
  std::vector<double> metres;
  std::vector<double> degrees;
  for (const ReplayUpdate& update : closure_updates(evaluation, "closure_jumps")) {
    metres.push_back(evaluation.alignment.scale *
                     (update.after.translation - update.before.translation).norm());
    degrees.push_back(kDegrees *
                      log_angle(update.before.rotation.conjugate() * update.after.rotation));
  }
  const int ddof = evaluation.protocol.ddof;
  return {{"translation", "3d", "m", statistics(std::move(metres), ddof)},
          {"rotation", "3d", "deg", statistics(std::move(degrees), ddof)}};
}

}  // namespace loopbench::metrics

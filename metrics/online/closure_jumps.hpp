/// Jumps of the current pose at closures.
#pragma once

#include "metrics/metric.hpp"
#include "metrics/numerics/angle.hpp"
#include "metrics/online/replay_of.hpp"

namespace loopbench::metrics {

/// Distance [m], scaled by the alignment, and rotation angle [deg] between the pose of the current
/// keyframe before and after each update with closures. `rmse` is the root mean square over these
/// updates, `max` the largest jump. Needs no reference. Throws Undefined if the method was not
/// replayed or no closure arrived. O(updates).
inline std::vector<Score> closure_jumps(const Evaluation& evaluation, const NoOptions& = {}) {
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

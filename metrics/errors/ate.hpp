/// Absolute trajectory error: distance of each pose from its reference after alignment.
#pragma once

#include <optional>

#include "datasets/core/parallel.hpp"
#include "metrics/errors/printed_motion.hpp"
#include "metrics/metric.hpp"
#include "metrics/numerics/angle.hpp"
#include "metrics/pairing/motion.hpp"

namespace loopbench::metrics {

/// translation 3d [m]: |p_reference - p_estimate|; rotation 3d [deg]: angle between the two
/// orientations, 0..180. evo's translation_part and rotation_angle_deg. Rotation is undefined for
/// trajectories that hold only positions (position_only.hpp). O(n).
inline std::vector<Score> ate(const Evaluation& evaluation, const NoOptions& = {}) {
  const std::size_t n = evaluation.reference.size();
  std::vector<double> metres(n);
  std::vector<double> degrees(n);
  const std::optional<PrintedPoses> printed = printed_for_evo(evaluation);
  parallel_for_blocks(n, [&](std::size_t i, std::size_t end) {
    for (; i < end; ++i) {
      const Pose& reference = evaluation.reference[i].world_from_body;
      const Pose& estimate = evaluation.estimate[i].world_from_body;
      metres[i] = (reference.translation - estimate.translation).norm();
      Rotation rotation = estimate.rotation.conjugate() * reference.rotation;
      if (printed) {
        rotation =
            pose_of(printed_relative_pose(printed->estimate[i], printed->reference[i])).rotation;
      }
      degrees[i] = kDegrees * log_angle(rotation);
    }
  });
  const int ddof = evaluation.protocol.ddof;
  Score rotation{"rotation", "3d", "deg", {}, why_no_attitude(evaluation)};
  if (rotation.why_undefined.empty()) rotation.statistics = statistics(std::move(degrees), ddof);
  return {{"translation", "3d", "m", statistics(std::move(metres), ddof)}, std::move(rotation)};
}

}  // namespace loopbench::metrics

/// Absolute trajectory error: distance of each pose from its reference after alignment.
#pragma once

#include "metrics/metric.hpp"

namespace loopbench::metrics {

/// translation 3d [m]: |p_reference - p_estimate|; rotation 3d [deg]: angle between the two
/// orientations, 0..180. evo's translation_part and rotation_angle_deg. Rotation is undefined for
/// trajectories that hold only positions (position_only.hpp). O(n).
std::vector<Score> ate(const Evaluation& evaluation, const NoOptions& options = {});

}  // namespace loopbench::metrics

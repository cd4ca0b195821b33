/// Absolute trajectory error: how far each pose is from its reference after alignment.
#pragma once

#include "metrics/metric.hpp"

namespace loopbench {

struct AteOptions {};

template <class Visit>
void fields(AteOptions&, Visit) {}

/// translation 3d [m]: |p_reference - p_estimate|; rotation 3d [deg]: the angle between the two
/// attitudes, 0..180. evo's translation_part and rotation_angle_deg. Rotation is undefined for
/// positions without attitude (position_only.hpp). O(n).
std::vector<Score> ate(const Evaluation& evaluation, const AteOptions& options);

}  // namespace loopbench

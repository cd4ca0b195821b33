/// Limits how far beyond the loops drift is extrapolated.
#pragma once

#include "methods/correctors/motion_drift/motion.hpp"

namespace loopbench::methods {

/// Sets `drift_part` of every edge. Loops measure drift only along the edges that they enclose. For
/// each regressor (edge, time, distance, rotation, speed) the reach is `reach` times the sum of
/// that regressor over all enclosed edges. Edges outside all loops have full drift while the
/// regressor accumulated between them and the nearest enclosed edge is within the reach, and no
/// drift beyond it. A loop of ten seconds therefore does not determine the drift of an hour outside
/// it. O(edges + closures).
void limit_drift(std::vector<EdgeMotion>& motions, const Problem& problem, double reach);

}  // namespace loopbench::methods

/// How far beyond the loops steady drift is extrapolated.
#pragma once

#include "methods/correctors/motion_drift/motion.hpp"

namespace loopbench {

/// Sets `drift_part` of every edge. Loops measure drift along the edges that they enclose; what
/// these edges accumulate together in one Growth (seconds, metres, radians) times `reach` is the
/// reach in that Growth. Edges outside all loops drift as far as the accumulated motion between
/// them and the nearest enclosed edge stays within the reach, and not at all beyond it. Ten seconds
/// in a loop therefore never decide about an hour outside of it. O(edges + closures).
void limit_drift(std::vector<EdgeMotion>& motions, const Problem& problem, double reach);

}  // namespace loopbench

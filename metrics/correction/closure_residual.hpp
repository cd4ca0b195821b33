/// Residuals of the loop closures after the correction.
#pragma once

#include "metrics/metric.hpp"

namespace loopbench::metrics {

/// E = L^-1 X_from^-1 X_to for every closure L, with X the unaligned estimate at its keyframes:
/// translation 3d [m] |trans(E)|, rotation 3d [deg] angle(E), and mahalanobis 3d [1]
/// sqrt(e^T information e) with e = Log(E); 6 degrees of freedom, so about sqrt(6) rms if the
/// information is consistent. A small residual shows that the closures were fitted, not that they
/// are correct. Throws Undefined without closures, and if a closure changes the scale (Sim(3)
/// chains). O(keyframes + closures).
std::vector<Score> closure_residual(const Evaluation& evaluation);

}  // namespace loopbench::metrics

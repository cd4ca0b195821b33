/// Change of the relative poses between neighbouring keyframes by the correction.
#pragma once

#include "metrics/metric.hpp"

namespace loopbench::metrics {

struct LocalShapeOptions {};

template <class Visit>
void fields(LocalShapeOptions&, Visit) {}

/// E = (K_i^-1 K_{i+1})^-1 (X_i^-1 X_{i+1}), K the input keyframes, X the estimate at them:
/// translation 3d [m], rotation 3d [deg] by which each relative pose changed. Uses no reference.
/// Zero for the raw trajectory under any rigid motion; a local bend gives a max far above the
/// median. Throws Undefined without a problem or with fewer than two keyframes. O(keyframes).
std::vector<Score> local_shape(const Evaluation& evaluation, const LocalShapeOptions& options);

}  // namespace loopbench::metrics

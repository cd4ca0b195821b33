/// How much a correction bent what odometry had measured between neighbours.
#pragma once

#include "metrics/metric.hpp"

namespace loopbench {

struct LocalShapeOptions {};

template <class Visit>
void fields(LocalShapeOptions&, Visit) {}

/// E = (K_i^-1 K_{i+1})^-1 (X_i^-1 X_{i+1}), K the keyframes as given, X the estimate at them:
/// translation 3d [m], rotation 3d [deg] by which each step changed. No reference enters. Zero for
/// the raw trajectory wherever it is moved to; a bend the drift did not ask for shows as max far
/// above median. Throws Undefined without a problem or with fewer than two keyframes.
/// O(keyframes).
std::vector<Score> local_shape(const Evaluation& evaluation, const LocalShapeOptions& options);

}  // namespace loopbench

/// What the loop closures still disagree with after the correction.
#pragma once

#include "metrics/metric.hpp"

namespace loopbench {

struct ClosureResidualOptions {};

template <class Visit>
void fields(ClosureResidualOptions&, Visit) {}

/// E = L^-1 X_from^-1 X_to for every closure L, X the estimate at its keyframes, not aligned:
/// translation 3d [m] |trans(E)|, rotation 3d [deg] angle(E), and mahalanobis 3d [1]
/// sqrt(e^T information e) with e = Log(E); 6 degrees of freedom, so about sqrt(6) rms when the
/// information tells the truth. A small residual says that the closures were believed, not that
/// they were right. Throws Undefined without closures, and when a closure changes the
/// unit of length (Sim(3) chains). O(keyframes + closures).
std::vector<Score> closure_residual(const Evaluation& evaluation,
                                    const ClosureResidualOptions& options);

}  // namespace loopbench

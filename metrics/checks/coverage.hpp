/// How much of the estimate and of the reference was judged at all.
#pragma once

#include "metrics/metric.hpp"

namespace loopbench {

struct CoverageOptions {};

template <class Visit>
void fields(CoverageOptions&, Visit) {}

/// Single values. In 0..1, each with count = judged pairs and std = 0: relation `share` (pairs
/// over possible pairs) and `span` (judged time, without losses, over the reference's duration).
/// `bridged` [s]: tracking gaps between keyframes that the curve bridges; 0 at keyframes.
std::vector<Score> coverage(const Evaluation& evaluation, const CoverageOptions& options);

}  // namespace loopbench

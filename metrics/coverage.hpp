/// How much of the estimate and of the reference was judged at all.
#pragma once

#include "metrics/metric.hpp"

namespace loopbench {

struct CoverageOptions {};

template <class Visit>
void fields(CoverageOptions&, Visit) {}

/// Two single values in 0..1, each with count = judged pairs and std = 0: relation `share` (pairs
/// over possible pairs) and `span` (judged time, without losses, over the reference's duration).
std::vector<Score> coverage(const Evaluation& evaluation, const CoverageOptions& options);

}  // namespace loopbench

/// Share of the estimate and of the reference that was evaluated.
#pragma once

#include "metrics/metric.hpp"

namespace loopbench::metrics {

/// Single values. In 0..1, each with count = evaluated pairs and std = 0: relation `share` (pairs
/// over possible pairs) and `span` (evaluated time, without tracking gaps, over the reference's
/// duration). `bridged` [s]: duration of tracking gaps that the curve bridges; 0 at keyframes.
std::vector<Score> coverage(const Evaluation& evaluation);

}  // namespace loopbench::metrics

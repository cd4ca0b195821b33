/// Problems whose edges change the scale, as those of monocular chains do.
#pragma once

#include <algorithm>

#include "datasets/core/problem.hpp"

namespace loopbench::methods {

/// Whether an edge changes the scale (a Sim(3) problem).
inline bool has_scale_drift(const Problem& problem) {
  const auto scaled = [](const Edge& edge) { return edge.scale != 1.0; };
  return std::ranges::any_of(problem.odometry, scaled) ||
         std::ranges::any_of(problem.closures, scaled);
}

}  // namespace loopbench::methods

/// Closures that are listed more than once.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "datasets/core/problem.hpp"

namespace loopbench::methods::consensus {

/// Index of the closure that each one repeats to rounding (six digits: 1e-5 rad, and 1e-5 of the
/// distance), or its own. A closure that is written twice, once in the other direction for example,
/// is one measurement; two measurements never agree like that. O(closures) for few between the same
/// keyframes.
inline std::vector<std::size_t> repeated_closures(const Problem& problem) {
  constexpr double kRounding = 1e-5;
  const std::vector<Edge>& closures = problem.closures;  // sorted by their ends
  std::vector<std::size_t> out(closures.size());
  for (std::size_t k = 0; k < closures.size(); ++k) {
    out[k] = k;
    const Edge& edge = closures[k];
    for (std::size_t i = k;
         i-- > 0 && closures[i].from == edge.from && closures[i].to == edge.to;) {
      const Pose error = closures[i].from_from_to.inverse() * edge.from_from_to;
      const double length = edge.from_from_to.translation.norm();
      if (error.translation.norm() <= kRounding * std::max(1.0, length) &&
          log_so3(error.rotation).norm() <= kRounding) {
        out[k] = out[i];
        break;
      }
    }
  }
  return out;
}

}  // namespace loopbench::methods::consensus

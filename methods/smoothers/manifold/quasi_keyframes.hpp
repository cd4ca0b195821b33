/// Step 1: inserts tracked frames as additional nodes where keyframes are too far apart.
#pragma once

#include <optional>

#include "datasets/core/problem.hpp"

namespace loopbench::methods::manifold {

struct GapRule {
  std::optional<double> time_max = 1.0;       ///< maximum gap without insertion [s]; none: no limit
  std::optional<double> rotation_max = 1.09;  ///< maximum rotation without insertion [rad]
  std::optional<double> common_min = 1.0;     ///< minimum common landmarks without insertion
};

struct NodesWithQuasiKeyframes {
  Trajectory nodes;           ///< keyframes and the quasi-keyframes between them
  std::size_t inserted = 0;   ///< number of quasi-keyframes
  std::size_t gaps_left = 0;  ///< gaps above the limits without any tracked frame
};

/// Divides each gap above the limits into equal parts within the limits and inserts the tracked
/// frame nearest to each division; poses are never interpolated. Gaps between keyframes with too
/// few common landmarks (problem.shared_landmarks, if known) are divided into at least two parts.
/// Source: article section 3.3, where frames are chosen manually. O(keyframes log frames).
NodesWithQuasiKeyframes with_quasi_keyframes(const Problem& problem, const GapRule& rule);

}  // namespace loopbench::methods::manifold

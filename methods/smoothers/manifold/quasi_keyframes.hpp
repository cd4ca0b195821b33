/// Step 1: tracked frames taken as extra nodes where keyframes are too far apart.
#pragma once

#include <optional>

#include "datasets/core/problem.hpp"

namespace loopbench::manifold {

struct GapRule {
  std::optional<double> time_max = 1.0;       ///< longest gap left alone [s]; none: any
  std::optional<double> rotation_max = 1.09;  ///< most rotation left alone [rad]; none: any
};

struct Densified {
  Trajectory nodes;           ///< the keyframes, quasi-keyframes between them
  std::size_t inserted = 0;   ///< quasi-keyframes
  std::size_t gaps_left = 0;  ///< gaps over the rule that no tracked frame lies in
};

/// A gap is cut into equal parts that obey the rule and the tracked frame nearest to each cut is
/// taken; never an interpolated pose. Source: paper section 3.3, where the choice is by hand.
/// O(keyframes log frames).
Densified with_quasi_keyframes(const Problem& problem, const GapRule& rule);

}  // namespace loopbench::manifold

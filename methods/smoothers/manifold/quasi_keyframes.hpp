/// Step 1: tracked frames taken as extra nodes where keyframes are too far apart.
#pragma once

#include <optional>

#include "datasets/core/problem.hpp"

namespace loopbench::manifold {

struct GapRule {
  std::optional<double> time_max = 1.0;       ///< longest gap left alone [s]; none: any
  std::optional<double> rotation_max = 1.09;  ///< most rotation left alone [rad]; none: any
  std::optional<double> common_min = 1.0;     ///< fewest landmarks in common left alone; none: any
};

struct Densified {
  Trajectory nodes;           ///< the keyframes, quasi-keyframes between them
  std::size_t inserted = 0;   ///< quasi-keyframes
  std::size_t gaps_left = 0;  ///< gaps over the rule that no tracked frame lies in
};

/// The time from one pose to another cut into equal `parts`, the tracked frame strictly between
/// nearest to each cut appended to `out`, none twice. Returns how many. O(parts log frames).
std::size_t insert_frames(const StampedPose& here,
                          const StampedPose& next,
                          std::size_t parts,
                          const Trajectory& frames,
                          Trajectory& out);

/// A gap is cut into equal parts that obey the rule and the tracked frame nearest to each cut is
/// taken; never an interpolated pose. Keyframes that share fewer landmarks than the rule asks,
/// where that is known (problem.common_view), are parted in two at least. Source: paper
/// section 3.3, where the choice is by hand. O(keyframes log frames).
Densified with_quasi_keyframes(const Problem& problem, const GapRule& rule);

}  // namespace loopbench::manifold

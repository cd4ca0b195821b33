/// Position error that pairing poses of different times costs, whatever the estimate is.
#pragma once

#include <optional>

#include "metrics/evaluation/evaluation.hpp"

namespace loopbench {

struct AssociationError {
  double largest_difference = 0.0;  ///< between the stamps of a pair [s]
  double metres = 0.0;              ///< root mean square of |dt| times the reference's speed [m]
};

/// What the pairs of `evaluation` cost a perfect estimate: the distance that `reference`, the whole
/// one, moves between the two stamps of a pair, at its speed from the paired pose to its neighbour
/// on that side. Nothing for association `interpolate` and `index`. O(n log m).
std::optional<AssociationError> association_error(const Trajectory& reference,
                                                  const Evaluation& evaluation);

}  // namespace loopbench

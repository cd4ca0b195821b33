/// Position error caused by pairing poses of different times, independent of the estimate.
#pragma once

#include <optional>

#include "metrics/evaluation/evaluation.hpp"

namespace loopbench::metrics {

struct AssociationError {
  double largest_difference = 0.0;  ///< largest time difference within a pair [s]
  double metres = 0.0;              ///< root mean square of |dt| times the reference's speed [m]
};

/// Position error that a perfect estimate would have with the pairs of `evaluation`: the distance
/// that the complete `reference` moves between the two stamps of a pair, at its speed from the
/// paired pose to its neighbour on that side. nullopt for associations `interpolate` and `index`.
/// O(n log m).
std::optional<AssociationError> association_error(const Trajectory& reference,
                                                  const Evaluation& evaluation);

}  // namespace loopbench::metrics

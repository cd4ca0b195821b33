/// Lever arm of positions without rotations: an antenna, a prism.
#pragma once

#include <optional>

#include "metrics/pairing/association.hpp"

namespace loopbench::metrics {

struct PositionLever {
  Vector3 arm = Vector3::Zero();        ///< of the reference's point in the estimate's body [m]
  Vector3 deviation = Vector3::Zero();  ///< standard deviations [m]; 0: direction not significant
};

/// Least squares of reference positions over world, scale and lever arm: those of p + R c, with the
/// estimate's poses (R, p). Rotations of the estimate have to vary. Directions that are closer than
/// three standard deviations to zero, or that rotations do not determine, are zero. The deviation
/// follows from the scatter of twenty parts, so that drift counts. nullopt if there is none, or
/// below 20 poses. O(n).
std::optional<PositionLever> position_lever(const Paired& poses);

}  // namespace loopbench::metrics

/// Step 0: the up direction of the fitting frames.
#pragma once

#include <array>

#include "datasets/core/trajectory.hpp"

namespace loopbench::methods::manifold {

enum class UpDirection { pca, world_z };
inline auto choices(UpDirection) {
  return std::array{std::pair{"pca", UpDirection::pca}, std::pair{"world_z", UpDirection::world_z}};
}

/// Unit vector in the world. `pca` is the axis of least variance of the positions, so the result
/// rotates with the data. If this axis is not unique (straight line, at rest, equal variances) a
/// body axis of the first pose is used, which rotates with the data as well. The sign follows the
/// direction of travel; the fits do not depend on it, because mirrored z' and y' give mirrored
/// curves. O(n).
Vector3 up_axis(const Trajectory& nodes, UpDirection choice);

}  // namespace loopbench::methods::manifold

/// Step 0: which way is up for the fitting frames.
#pragma once

#include <array>

#include "datasets/core/trajectory.hpp"

namespace loopbench::manifold {

enum class Up { pca, world_z };
inline auto choices(Up) {
  return std::array{std::pair{"pca", Up::pca}, std::pair{"world_z", Up::world_z}};
}

/// Unit vector in the world. `pca` is the axis along which the positions vary least, so the
/// result moves with the data and not with the world's axes. Where that axis is no axis (straight
/// line, standing still, as wide as it is high) a body axis of the first pose decides, which moves
/// with the data too. Its sign follows the sense of travel; no fit depends on it: mirrored z' and
/// y' give mirrored curves. O(n).
Vector3 up_axis(const Trajectory& nodes, Up choice);

}  // namespace loopbench::manifold

/// Step 8 in space: z' = q(x', y') on windows of M nodes.
#pragma once

#include <optional>
#include <span>

#include "methods/smoothers/manifold/families/quadric.hpp"
#include "methods/smoothers/manifold/joints.hpp"

namespace loopbench::manifold {

/// Height over a place; empty: the place keeps the height it has.
struct Height {
  struct Surface {
    Frame frame;
    Quadric quadric;
  };
  std::optional<Surface> surface;

  double over(const Vector3& point, double own_height) const {
    return surface ? surface->quadric(surface->frame.local(point)) : own_height;
  }
};

struct SpatialFit {
  std::vector<Window> windows;
  std::vector<Height> pieces;  ///< one for each window
  std::size_t truncated = 0;   ///< windows whose nodes lie near a conic
  std::size_t fallbacks = 0;   ///< windows that keep the height they have
};

/// Heights along `up`, from the first node. O(nodes).
SpatialFit fit_spatial(const Nodes& nodes,
                       std::span<const NodeRange> segments,
                       const Vector3& up,
                       std::size_t M);

}  // namespace loopbench::manifold

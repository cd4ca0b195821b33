/// The frame a window is fitted in, and whether its nodes are a graph y' = f(x') there.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "methods/smoothers/manifold/nodes.hpp"

namespace loopbench::manifold {

using Vector2 = Eigen::Vector2d;

/// chord: x' from first to last node. world: the axes of the world, as the article has it. pca: x'
/// along the most spread of the nodes. parametric: no y' = f(x') at all, r(s) instead.
enum class Axes { chord, world, pca, parametric };
inline auto choices(Axes) {
  return std::array{std::pair{"chord", Axes::chord},
                    std::pair{"world", Axes::world},
                    std::pair{"pca", Axes::pca},
                    std::pair{"parametric", Axes::parametric}};
}

struct Frame {
  Vector3 origin;  ///< the first node, or the world's [m]
  Vector3 x;       ///< unit, along the chord as seen from above
  Vector3 y;       ///< unit, to the left; z' is up

  Vector2 local(const Vector3& point) const {
    const Vector3 from_origin = point - origin;
    return {x.dot(from_origin), y.dot(from_origin)};
  }
};

/// x' from the first to the last node, levelled so that z' is exactly `up`. Nothing when the
/// chord has no level part to speak of: standing still, a closed or a vertical window.
std::optional<Frame> chord_frame(const Nodes& nodes, NodeRange range, const Vector3& up);

/// x' along the direction in which the nodes, seen from above, spread most, pointing the way they
/// travel. Nothing when they spread alike in all directions, or end where they begin.
std::optional<Frame> pca_frame(const Nodes& nodes, NodeRange range, const Vector3& up);

/// The frame of the window; for `parametric` and the spatial step, the chord's.
std::optional<Frame> fitting_frame(Axes axes,
                                   const Nodes& nodes,
                                   NodeRange range,
                                   const Vector3& up);

/// Nodes in the frame [m].
std::vector<Vector2> local(const Nodes& nodes, NodeRange range, const Frame& frame);

/// The guard: every step advances by more than a tenth of the mean step, and all turning together
/// stays below a right angle. Without it y = f(x) is many-valued on any loop.
bool is_graph(std::span<const Vector2> points);

}  // namespace loopbench::manifold

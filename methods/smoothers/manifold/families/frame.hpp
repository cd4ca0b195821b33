/// Fitting frame of a window, and the test whether its nodes are a graph y' = f(x').
#pragma once

#include <array>
#include <optional>
#include <span>

#include "methods/smoothers/manifold/families/nodes.hpp"

namespace loopbench::methods::manifold {

using Vector2 = Eigen::Vector2d;

/// chord: x' from the first to the last node. world: world axes, as in the article.
enum class Axes { chord, world };
inline auto choices(Axes) {
  return std::array{std::pair{"chord", Axes::chord}, std::pair{"world", Axes::world}};
}

struct Frame {
  Vector3 origin;  ///< the first node or the world origin [m]
  Vector3 x;       ///< unit vector, along the chord projected along the up axis
  Vector3 y;       ///< unit vector, to the left; z' is up

  Vector2 local(const Vector3& point) const {
    const Vector3 from_origin = point - origin;
    return {x.dot(from_origin), y.dot(from_origin)};
  }
};

/// Frame with x' from the first to the last node, projected so that z' is exactly `up`. Returns
/// nullopt when the projected chord is too short: at rest, or for a closed or vertical window.
std::optional<Frame> chord_frame(const Nodes& nodes, NodeRange range, const Vector3& up);

/// Frame of a window for `axes`.
std::optional<Frame> fitting_frame(Axes axes,
                                   const Nodes& nodes,
                                   NodeRange range,
                                   const Vector3& up);

/// Guard: true if every step advances by more than a tenth of the mean step and the total rotation
/// angle is below a right angle. Otherwise y = f(x) may be multivalued, as on any loop.
bool is_graph(std::span<const Vector2> points);

}  // namespace loopbench::methods::manifold

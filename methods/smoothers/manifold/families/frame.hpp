/// Fitting frame of a window, and the test whether its nodes are a graph y' = f(x').
#pragma once

#include <array>
#include <optional>
#include <span>

#include "methods/smoothers/manifold/families/nodes.hpp"

namespace loopbench::methods::manifold {

using Vector2 = Eigen::Vector2d;

/// chord: x' from the first to the last node. world: world axes, as in the article. pca: x' along
/// the direction of largest variance of the nodes. parametric: r(s) instead of y' = f(x').
enum class Axes { chord, world, pca, parametric };
inline auto choices(Axes) {
  return std::array{std::pair{"chord", Axes::chord},
                    std::pair{"world", Axes::world},
                    std::pair{"pca", Axes::pca},
                    std::pair{"parametric", Axes::parametric}};
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

/// Frame with x' along the direction of largest variance of the projected nodes, oriented in the
/// direction of travel. Returns nullopt when the variance is equal in all directions, or when the
/// window ends where it begins.
std::optional<Frame> pca_frame(const Nodes& nodes, NodeRange range, const Vector3& up);

/// Frame of a window for `axes`; the chord frame for `parametric`.
std::optional<Frame> fitting_frame(Axes axes,
                                   const Nodes& nodes,
                                   NodeRange range,
                                   const Vector3& up);

/// Nodes in the coordinates of the frame [m].
std::vector<Vector2> local(const Nodes& nodes, NodeRange range, const Frame& frame);

/// Guard: true if every step advances by more than a tenth of the mean step and the total rotation
/// angle is below a right angle. Otherwise y = f(x) may be multivalued, as on any loop.
bool is_graph(std::span<const Vector2> points);

}  // namespace loopbench::methods::manifold

/// Step 8 in the plane: y' = f(x') on windows of N nodes, with the guard and what follows it.
#pragma once

#include <span>
#include <variant>

#include "methods/smoothers/manifold/families/arc.hpp"
#include "methods/smoothers/manifold/families/polynomial.hpp"
#include "methods/smoothers/manifold/joints.hpp"
#include "methods/smoothers/manifold/spline.hpp"

namespace loopbench::manifold {

enum class Fallback { arc, spline };
inline auto choices(Fallback) {
  return std::array{std::pair{"arc", Fallback::arc}, std::pair{"spline", Fallback::spline}};
}

/// The spline with its y' replaced by the fitted curve at its x'.
struct Graph {
  Frame frame;
  Polynomial curve;

  Vector3 operator()(const Place& place) const {
    const Vector2 on_spline = frame.local(place.point);
    return place.point + (curve(on_spline.x()) - on_spline.y()) * frame.y;
  }
};

/// The spline itself.
struct AsSpline {
  Vector3 operator()(const Place& place) const { return place.point; }
};

/// The parametric curve at the spline's way.
struct AsArc {
  Arc arc;
  Vector3 operator()(const Place& place) const { return arc(place.way); }
};

using PlanarPiece = std::variant<Graph, AsArc, AsSpline>;

struct PlanarFit {
  std::vector<Window> windows;
  std::vector<PlanarPiece> pieces;  ///< one for each window
  std::size_t split = 0;            ///< windows the guard sent back in parts of three nodes
  std::size_t fallbacks = 0;        ///< pieces that are no graph
};

/// Family by N: parabola for 3, cubic for 4 (both through their nodes), cubic by least squares
/// for 5. A window that is no graph is split into windows of three nodes; those that are none
/// either take the fallback. O(nodes).
PlanarFit fit_planar(const Nodes& nodes,
                     std::span<const NodeRange> segments,
                     const NodeSpline& spline,
                     const Vector3& up,
                     std::size_t N,
                     Fallback fallback);

}  // namespace loopbench::manifold

/// Step 8 in space: z' = q(x', y') on windows of M nodes.
#pragma once

#include <optional>
#include <span>

#include "methods/smoothers/manifold/families/quadric.hpp"
#include "methods/smoothers/manifold/spline.hpp"
#include "methods/smoothers/manifold/windows.hpp"

namespace loopbench::manifold {

/// Height over a place; empty: the place keeps the height it has.
struct Height {
  struct Surface {
    Frame frame;
    Quadric quadric;

    double height(const Vector3& point) const { return quadric(frame.local(point)); }
    Jet<double> height(const Moving& point) const {
      const Moving from_origin = point - frame.origin;
      return quadric(along(frame.x, from_origin), along(frame.y, from_origin));
    }
  };
  std::optional<Surface> surface;

  template <class T>
  T over(const VectorOf<T>& point, const T& own_height) const {
    return surface ? surface->height(point) : own_height;
  }
};

struct SpatialRule {
  std::size_t size = 7;  ///< M
  Axes axes = Axes::chord;
  bool guarded = true;
  Scheme scheme = Scheme::consecutive;
  double cut = kQuadricCut;     ///< weaker directions are dropped [of the strongest]
  std::size_t plain_below = 0;  ///< segments of fewer nodes keep the height they have
};

struct SpatialFit {
  std::vector<Window> windows;
  std::vector<Height> pieces;  ///< one for each window
  std::size_t truncated = 0;   ///< windows whose nodes lie near a conic
  std::size_t fallbacks = 0;   ///< windows that keep the height they have
};

/// Heights along `up`, from the first node. `guarded`: a surface that leaves the spline, on the
/// edges it stands for or the next one, by more than the whole range of its nodes' heights says
/// nothing about them and is not used; nodes nearly on a conic give such surfaces even truncated.
/// O(nodes).
SpatialFit fit_spatial(const Nodes& nodes,
                       std::span<const NodeRange> segments,
                       const NodeSpline& spline,
                       const Vector3& up,
                       const SpatialRule& rule);

}  // namespace loopbench::manifold

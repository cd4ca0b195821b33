/// Step 8 in space: z' = q(x', y') on windows of M nodes.
#pragma once

#include <optional>
#include <span>

#include "methods/smoothers/manifold/families/quadric.hpp"
#include "methods/smoothers/manifold/spline.hpp"
#include "methods/smoothers/manifold/windows.hpp"

namespace loopbench::methods::manifold {

/// Height as a function of position; empty: the spline's height is kept.
struct Height {
  struct Surface {
    Frame frame;
    Quadric quadric;

    double height(const Vector3& point) const { return quadric(frame.local(point)); }
    Jet<double> height(const MotionJet& point) const {
      const MotionJet from_origin = point - frame.origin;
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
  double cut = kQuadricCut;     ///< relative singular value below which directions are dropped
  std::size_t plain_below = 0;  ///< segments with fewer nodes keep the spline's height
};

struct SpatialFit {
  std::vector<Window> windows;
  std::vector<Height> pieces;  ///< one per window
  std::size_t truncated = 0;   ///< windows whose nodes lie near a conic
  std::size_t fallbacks = 0;   ///< windows that keep the spline's height
};

/// Fits heights along `up`, relative to the first node. `guarded`: rejects a surface that leaves
/// the spline, on its own edges or one edge next to them, by more than the height range of its
/// nodes; nodes near a conic produce such surfaces even with truncation. O(nodes).
SpatialFit fit_spatial(const Nodes& nodes,
                       std::span<const NodeRange> segments,
                       const NodeSpline& spline,
                       const Vector3& up,
                       const SpatialRule& rule);

}  // namespace loopbench::methods::manifold

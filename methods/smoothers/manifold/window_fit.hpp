/// Fit of one window: frame, guard, candidate families and selection.
#pragma once

#include "methods/smoothers/manifold/planar.hpp"

namespace loopbench::methods::manifold {

/// Data shared by the steps of fitting a window.
struct WindowFitter {
  const Nodes& nodes;
  const NodeSpline& spline;
  const Vector3& up;
  const PlanarRule& rule;

  /// Returns the selected family fitted to the window's nodes, or nullopt if there is no frame, no
  /// graph, or all families fail.
  std::optional<PlanarPiece> fit(const Window& window, std::span<const Family> families) const;

  /// Whether a frame exists and, with the guard, whether the nodes are a graph in it.
  bool admits(const Window& window) const;

 private:
  std::optional<PlanarPiece> fit(Family family,
                                 const std::optional<Frame>& frame,
                                 std::span<const std::size_t> picked) const;
  double score(Family family,
               const PlanarPiece& piece,
               const std::optional<Frame>& frame,
               std::span<const std::size_t> picked) const;
  double squared_error(const PlanarPiece& piece, std::size_t node) const;
  bool stays_near_spline(const PlanarPiece& piece, const Window& window) const;
};

}  // namespace loopbench::methods::manifold

/// One window: frame, guard, candidates, choice.
#pragma once

#include "methods/smoothers/manifold/planar.hpp"

namespace loopbench::manifold {

/// What the steps inside a window share.
struct WindowFitter {
  const Nodes& nodes;
  const NodeSpline& spline;
  const Vector3& up;
  const PlanarRule& rule;

  /// The chosen family on the window's nodes, or nothing: no frame, no graph, all refused.
  std::optional<PlanarPiece> fit(const Window& window, std::span<const Family> families) const;

  /// Whether the nodes may be a graph in the window's frame, the guard's opinion or none.
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
  bool is_tame(const PlanarPiece& piece, const Window& window) const;
};

}  // namespace loopbench::manifold

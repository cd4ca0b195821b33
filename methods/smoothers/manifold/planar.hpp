/// Step 8 in the plane: y' = f(x') on windows of N nodes, with guard and fallback.
#pragma once

#include <functional>
#include <span>

#include "methods/smoothers/manifold/family.hpp"
#include "methods/smoothers/manifold/selection.hpp"
#include "methods/smoothers/manifold/windows.hpp"

namespace loopbench::methods::manifold {

enum class Fallback { arc, spline };
inline auto choices(Fallback) {
  return std::array{std::pair{"arc", Fallback::arc}, std::pair{"spline", Fallback::spline}};
}

/// Cost of a piece for a window, evaluated at the points of `spline`; lower is better.
using PieceCost = std::function<double(
    const PlanarPiece& piece, const Window& window, const Nodes& nodes, const NodeSpline& spline)>;

struct PlanarRule {
  std::size_t size = 4;  ///< N
  Axes axes = Axes::chord;
  bool guarded = true;
  Scheme scheme = Scheme::consecutive;
  std::vector<Family> families{Family::by_n};
  Selection selection = Selection::fixed;
  PieceCost piece_cost = {};  ///< selects the family instead of `selection`; used by an oracle only
  Fallback fallback = Fallback::arc;
  std::size_t chords_below = 0;  ///< segments with fewer nodes become straight lines
};

struct PlanarFit {
  std::vector<Window> windows;
  std::vector<PlanarPiece> pieces;  ///< one per window
  std::size_t split = 0;            ///< windows split into windows of three nodes by the guard
  std::size_t fallbacks = 0;        ///< pieces that are not curves of a family
  std::size_t refused = 0;          ///< windows where all families failed and a polynomial is used
  std::size_t chords = 0;           ///< pieces that are straight lines due to the short policy

  void keep(const Window& window, const PlanarPiece& piece) {
    windows.push_back(window);
    pieces.push_back(piece);
  }
};

/// Fits the windows of all segments. With the guard, a window that is not a graph is split into
/// windows of three nodes, and those that are still not a graph use the fallback; a curve of a
/// family other than a polynomial is rejected if it leaves the spline, on the edges where it is
/// evaluated, by more than a quarter of its chord. Without the guard, every solvable fit is used,
/// and the spline elsewhere. O(nodes).
PlanarFit fit_planar(const Nodes& nodes,
                     std::span<const NodeRange> segments,
                     const NodeSpline& spline,
                     const Vector3& up,
                     const PlanarRule& rule);

}  // namespace loopbench::methods::manifold

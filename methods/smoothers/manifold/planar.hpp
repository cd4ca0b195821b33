/// Step 8 in the plane: y' = f(x') on windows of N nodes, with the guard and what follows it.
#pragma once

#include <functional>
#include <span>

#include "methods/smoothers/manifold/family.hpp"
#include "methods/smoothers/manifold/selection.hpp"
#include "methods/smoothers/manifold/windows.hpp"

namespace loopbench::manifold {

enum class Fallback { arc, spline };
inline auto choices(Fallback) {
  return std::array{std::pair{"arc", Fallback::arc}, std::pair{"spline", Fallback::spline}};
}

/// How badly a piece stands for a window, less is better; at `spline`'s places.
using PieceJudge = std::function<double(
    const PlanarPiece& piece, const Window& window, const Nodes& nodes, const NodeSpline& spline)>;

struct PlanarRule {
  std::size_t size = 4;  ///< N
  Axes axes = Axes::chord;
  bool guarded = true;
  Scheme scheme = Scheme::consecutive;
  std::vector<Family> families{Family::by_n};
  FamilyRule family = {};
  Selection selection = Selection::fixed;
  PieceJudge judge = {};  ///< chooses in the place of `selection`; only an oracle has one
  Fallback fallback = Fallback::arc;
  std::size_t chords_below = 0;  ///< segments of fewer nodes become straight lines
};

struct PlanarFit {
  std::vector<Window> windows;
  std::vector<PlanarPiece> pieces;  ///< one for each window
  std::size_t split = 0;            ///< windows the guard sent back in parts of three nodes
  std::size_t fallbacks = 0;        ///< pieces that are no curve of a family
  std::size_t refused = 0;          ///< windows whose families all refused: a polynomial instead
  std::size_t chords = 0;           ///< pieces that are straight lines by the short policy

  void keep(const Window& window, const PlanarPiece& piece) {
    windows.push_back(window);
    pieces.push_back(piece);
  }
};

/// A guarded window that is no graph is split into windows of three nodes; those that are none
/// either take the fallback. Unguarded, whatever can be solved is taken and the rest is the
/// spline. A family other than a polynomial that leaves the spline, on the edges it is asked for,
/// by more than a quarter of its chord is refused when guarded. O(nodes).
PlanarFit fit_planar(const Nodes& nodes,
                     std::span<const NodeRange> segments,
                     const NodeSpline& spline,
                     const Vector3& up,
                     const PlanarRule& rule);

}  // namespace loopbench::manifold

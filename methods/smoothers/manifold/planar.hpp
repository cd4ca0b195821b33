/// Step 8 in the plane: y' = f(x') on windows of N nodes, with guard and fallback.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "methods/smoothers/manifold/pieces.hpp"
#include "methods/smoothers/manifold/windows.hpp"

namespace loopbench::methods::manifold {

/// by_n: parabola for 3 nodes, cubic for more. The others are named in the article.
enum class Family { by_n, line, poly2, poly3, sin1, rat02, hyperbola, implicit };
inline auto choices(Family) {
  return std::array{std::pair{"by_n", Family::by_n},
                    std::pair{"line", Family::line},
                    std::pair{"poly2", Family::poly2},
                    std::pair{"poly3", Family::poly3},
                    std::pair{"sin1", Family::sin1},
                    std::pair{"rat02", Family::rat02},
                    std::pair{"hyperbola", Family::hyperbola},
                    std::pair{"implicit", Family::implicit}};
}

/// Parses a list such as "poly2 sin1" or "poly2, sin1". Throws OptionError for an unknown family or
/// an empty list.
std::vector<Family> read_families(const std::string& names);

/// Returns the number of parameters of the family for this number of nodes, as used by `selection`.
std::size_t unknowns(Family family, std::size_t nodes);

bool is_polynomial(Family family);

/// Fits the family to points in the frame. Returns nullopt for too few points or an invalid fit (a
/// pole, an alias, no extent).
std::optional<PlanarPiece> fit_family(Family family,
                                      const Frame& frame,
                                      std::span<const Vector2> points);

/// fixed: the first family of the list that can be fitted. loocv: lowest squared error in
/// leave-one-out cross-validation over the nodes.
enum class Selection { fixed, loocv };
inline auto choices(Selection) {
  return std::array{std::pair{"fixed", Selection::fixed}, std::pair{"loocv", Selection::loocv}};
}

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

/// Data shared by the steps of fitting a window: frame, guard, candidate families and selection.
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
                                 const Frame& frame,
                                 std::span<const std::size_t> picked) const;
  double leave_one_out(Family family,
                       const Frame& frame,
                       std::span<const std::size_t> picked) const;
  double squared_error(const PlanarPiece& piece, std::size_t node) const;
  bool stays_near_spline(const PlanarPiece& piece, const Window& window) const;
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

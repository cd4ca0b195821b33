/// Step 7: the curve through all nodes, x'(t) and z'(t) of every window at once.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "methods/smoothers/manifold/bspline.hpp"
#include "methods/smoothers/manifold/nodes.hpp"

namespace loopbench::manifold {

/// Where the spline is: a position [m], the way along the nodes [m], and when [s].
template <class T>
struct PlaceOf {
  VectorOf<T> point;
  T way;
  T time;
};
using Place = PlaceOf<double>;
using MovingPlace = PlaceOf<Jet<double>>;

/// Which x is used to find the corresponding y.
enum class Abscissa { spline, polyline };
inline auto choices(Abscissa) {
  return std::array{std::pair{"spline", Abscissa::spline},
                    std::pair{"polyline", Abscissa::polyline}};
}

/// A node the spline passes with a given velocity; the cubic is C1 there and no more.
struct Clamp {
  std::size_t node;
  Vector3 velocity;  ///< [m/s]
};

/// The interpolating cubic B-spline with natural ends and time as its parameter. Held as values
/// and second derivatives at the nodes (the same function, cheaper to ask). One spline over the
/// whole trajectory: one for each segment would have no acceleration at every joint and could not
/// be C2 there. Coordinates in any fitting frame are linear in it, so frames share it.
class NodeSpline {
 public:
  explicit NodeSpline(const Nodes& nodes);  ///< two nodes or more; O(n)

  /// Clamped in the given nodes, which increase: where segments end, to the optimal tangent psi.
  NodeSpline(const Nodes& nodes, std::span<const Clamp> clamps);

  /// Straight lines between the nodes.
  static NodeSpline polyline(const Nodes& nodes);

  /// B-spline of another order (bspline.hpp); 4 there has its knots between the nodes, not natural
  /// ends.
  static NodeSpline of_order(const Nodes& nodes, std::size_t order);

  /// `time` in stamps[edge]..stamps[edge + 1]. O(1), O(log n) for another order.
  Place at(std::size_t edge, double time) const;
  MovingPlace at(std::size_t edge, const Jet<double>& time) const;

  double way(std::size_t node) const { return knots_[node].value[3]; }

 private:
  using Value = Eigen::Vector4d;  ///< x, y, z and the way
  struct Knot {
    Value value;
    Value before, after;  ///< second derivative by time on either side
  };
  struct Straight {};
  NodeSpline(const Nodes& nodes, Straight);
  void bend(std::size_t first, std::size_t last, const Clamp* start, const Clamp* end);

  std::vector<double> stamps_;
  std::vector<Knot> knots_;
  std::optional<BSpline> other_;
};

}  // namespace loopbench::manifold

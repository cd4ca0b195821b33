/// Step 7: the curve through all nodes, which gives x'(t) and z'(t) for every window.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "methods/smoothers/manifold/families/jet.hpp"
#include "methods/smoothers/manifold/families/nodes.hpp"
#include "methods/smoothers/spline/basis.hpp"

namespace loopbench::methods::manifold {

/// C(u) = sum of P_t N_{t,k}(u).
struct BSpline {
  using Value = Eigen::Vector4d;

  SplineBasis basis;
  std::vector<Value> controls;

  /// Interpolates values[i] at sites[i] (at least two, strictly increasing); the first value must
  /// be zero for full precision. Order 2..6, reduced to the number of sites. O(n k^2).
  static BSpline through(const std::vector<double>& sites,
                         const std::vector<Value>& values,
                         std::size_t order);

  Value at(double u) const;
  Jet<Value> at(const Jet<double>& u) const;
};

/// Point of the spline: position [m], arc length along the nodes [m] and time [s].
template <class T>
struct SplinePointOf {
  VectorOf<T> point;
  T distance;
  T time;
};
using SplinePoint = SplinePointOf<double>;
using SplinePointJet = SplinePointOf<Jet<double>>;

/// Curve that provides the x' at which y' is evaluated.
enum class Abscissa { spline, polyline };
inline auto choices(Abscissa) {
  return std::array{std::pair{"spline", Abscissa::spline},
                    std::pair{"polyline", Abscissa::polyline}};
}

/// Node with a prescribed velocity; the cubic is only C1 there.
struct Clamp {
  std::size_t node;
  Vector3 velocity;  ///< [m/s]
};

/// Interpolating cubic spline with natural ends in time, stored as values and second derivatives at
/// the nodes, which is cheaper to evaluate than B-spline coefficients. One spline covers the whole
/// trajectory; a natural spline per segment would have zero acceleration at every joint.
/// Coordinates in any fitting frame are linear in the spline, so all frames share it.
class NodeSpline {
 public:
  explicit NodeSpline(const Nodes& nodes);  ///< requires at least two nodes; O(n)

  /// Spline with prescribed velocities at the given nodes (increasing): psi at segment ends.
  NodeSpline(const Nodes& nodes, std::span<const Clamp> clamps);

  /// Straight lines between the nodes.
  static NodeSpline polyline(const Nodes& nodes);

  /// B-spline of another order. Its order 4 has knots between the nodes instead of
  /// natural ends.
  static NodeSpline of_order(const Nodes& nodes, std::size_t order);

  /// Point at `time` in stamps[edge]..stamps[edge + 1]. O(1), or O(log n) for another order.
  SplinePoint at(std::size_t edge, double time) const;
  SplinePointJet at(std::size_t edge, const Jet<double>& time) const;

  double distance(std::size_t node) const { return knots_[node].value[3]; }

 private:
  using Value = Eigen::Vector4d;  ///< x, y, z and arc length
  struct Knot {
    Value value;
    Value before, after;  ///< second time derivative on either side
  };
  struct Straight {};
  NodeSpline(const Nodes& nodes, Straight);
  void solve_second_derivatives(std::size_t first,
                                std::size_t last,
                                const Clamp* start,
                                const Clamp* end);
  template <class Result, class Time>
  Result value_at(std::size_t edge, const Time& time) const;

  std::vector<double> stamps_;
  std::vector<Knot> knots_;
  std::optional<BSpline> b_spline_;  ///< set by of_order()
};

}  // namespace loopbench::methods::manifold

/// Curve types for a window of the planar step. Each maps a spline point, at a time or a Jet of
/// time, to a point of the fitted curve.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <variant>

#include "methods/smoothers/manifold/families/fitting.hpp"
#include "methods/smoothers/manifold/families/graph.hpp"
#include "methods/smoothers/manifold/families/implicit.hpp"
#include "methods/smoothers/manifold/families/jet.hpp"
#include "methods/smoothers/manifold/spline.hpp"

namespace loopbench::methods::manifold {

/// Parabola through three points in Newton's form, which is stable when two of them nearly coincide
/// because every divided difference is bounded by a chord length.
struct Arc {
  std::array<double, 2> s{};            ///< first and second node [m]
  std::array<Vector3, 3> difference{};  ///< divided differences of order 0, 1, 2

  template <class T>
  VectorOf<T> operator()(const T& arc_length) const {
    return difference[0] +
           (arc_length - s[0]) * (difference[1] + (arc_length - s[1]) * difference[2]);
  }
};

/// Fits the parabola to three points and their arc lengths [m]. Returns nullopt when two coincide.
inline std::optional<Arc> fit_arc(std::span<const Vector3, 3> r, std::span<const double, 3> s) {
  if (!(s[1] > s[0]) || !(s[2] > s[1])) return std::nullopt;
  const Vector3 first = (r[1] - r[0]) / (s[1] - s[0]);
  const Vector3 second = (r[2] - r[1]) / (s[2] - s[1]);
  return Arc{{s[0], s[1]}, {r[0], first, (second - first) / (s[2] - s[0])}};
}

/// Spline point with y' replaced by the fitted curve at its x'.
template <class Function>
struct GraphPiece {
  Frame frame;
  Function curve;

  template <class T>
  VectorOf<T> operator()(const SplinePointOf<T>& position) const {
    const VectorOf<T> from_origin = position.point - frame.origin;
    const T x = along(frame.x, from_origin);
    const T y = along(frame.y, from_origin);
    return position.point + (curve(x) - y) * frame.y;
  }
};

/// Spline point moved in the plane to the nearest point of F(x', y') = 0, which may have several y'
/// for one x'. The spline point is kept where no such point is found.
struct ImplicitPiece {
  Frame frame;
  Implicit curve;

  template <class T>
  VectorOf<T> operator()(const SplinePointOf<T>& position) const {
    const VectorOf<T> from_origin = position.point - frame.origin;
    const T x = along(frame.x, from_origin);
    const T y = along(frame.y, from_origin);
    const auto on = curve.nearest(x, y);
    if (!on) return position.point;
    return position.point + ((on->first - x) * frame.x + (on->second - y) * frame.y);
  }
};

/// The parabola evaluated at the spline's arc length.
struct ArcPiece {
  Arc curve;

  template <class T>
  VectorOf<T> operator()(const SplinePointOf<T>& position) const {
    return curve(position.distance);
  }
};

/// Straight line between two nodes.
struct ChordPiece {
  double begin, end;  ///< [s]
  Vector3 from, to;   ///< [m]

  template <class T>
  VectorOf<T> operator()(const SplinePointOf<T>& position) const {
    const T s = (position.time - begin) / (end - begin);
    return from + s * Vector3(to - from);
  }
};

/// The spline unchanged.
struct SplinePiece {
  template <class T>
  VectorOf<T> operator()(const SplinePointOf<T>& position) const {
    return position.point;
  }
};

using PlanarPiece = std::variant<GraphPiece<Polynomial>,
                                 GraphPiece<Sine>,
                                 GraphPiece<Rational>,
                                 GraphPiece<Hyperbola>,
                                 ImplicitPiece,
                                 ArcPiece,
                                 ChordPiece,
                                 SplinePiece>;

template <class T>
VectorOf<T> value_of_piece(const PlanarPiece& piece, const SplinePointOf<T>& position) {
  return std::visit([&](const auto& shape) { return shape(position); }, piece);
}

}  // namespace loopbench::methods::manifold

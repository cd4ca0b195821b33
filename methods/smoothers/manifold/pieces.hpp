/// Curve types for a window of the planar step. Each maps a spline point, at a time or a Jet of
/// time, to a point of the fitted curve.
#pragma once

#include <memory>
#include <variant>

#include "methods/smoothers/manifold/families/arc.hpp"
#include "methods/smoothers/manifold/families/arc_polynomial.hpp"
#include "methods/smoothers/manifold/families/hyperbola.hpp"
#include "methods/smoothers/manifold/families/implicit.hpp"
#include "methods/smoothers/manifold/families/polynomial.hpp"
#include "methods/smoothers/manifold/families/rational.hpp"
#include "methods/smoothers/manifold/families/sine.hpp"
#include "methods/smoothers/manifold/spline.hpp"

namespace loopbench::methods::manifold {

/// Spline point with y' replaced by the fitted curve at its x'.
template <class Function>
struct Graph {
  Frame frame;
  Function curve;

  template <class T>
  VectorOf<T> operator()(const PlaceOf<T>& place) const {
    const VectorOf<T> from_origin = place.point - frame.origin;
    const T x = along(frame.x, from_origin);
    const T y = along(frame.y, from_origin);
    return place.point + (curve(x) - y) * frame.y;
  }
};

/// Spline point moved in the plane to the nearest point of F(x', y') = 0, which may have several y'
/// for one x'. The spline point is kept where no such point is found.
struct AsImplicit {
  Frame frame;
  Implicit curve;

  template <class T>
  VectorOf<T> operator()(const PlaceOf<T>& place) const {
    const VectorOf<T> from_origin = place.point - frame.origin;
    const T x = along(frame.x, from_origin);
    const T y = along(frame.y, from_origin);
    const auto on = curve.nearest(x, y);
    if (!on) return place.point;
    return place.point + ((on->first - x) * frame.x + (on->second - y) * frame.y);
  }
};

/// A parametric curve evaluated at the spline's arc length.
template <class Function>
struct Along {
  Function curve;

  template <class T>
  VectorOf<T> operator()(const PlaceOf<T>& place) const {
    return curve(place.way);
  }
};
using AsArc = Along<Arc>;
using AsArcPolynomial = Along<ArcPolynomial>;

/// A cubic regression spline r(s) for the whole trajectory.
struct AsRegression {
  std::shared_ptr<const BSpline> curve;

  Vector3 operator()(const Place& place) const { return curve->at(place.way).head<3>(); }
  Moving operator()(const MovingPlace& place) const {
    const auto out = curve->at(place.way);
    return {out.value.head<3>(), out.first.head<3>(), out.second.head<3>()};
  }
};

/// Straight line between two nodes.
struct AsChord {
  double begin, end;  ///< [s]
  Vector3 from, to;   ///< [m]

  template <class T>
  VectorOf<T> operator()(const PlaceOf<T>& place) const {
    const T s = (place.time - begin) / (end - begin);
    return from + s * Vector3(to - from);
  }
};

/// The spline unchanged.
struct AsSpline {
  template <class T>
  VectorOf<T> operator()(const PlaceOf<T>& place) const {
    return place.point;
  }
};

using PlanarPiece = std::variant<Graph<Polynomial>,
                                 Graph<Sine>,
                                 Graph<Rational>,
                                 Graph<Hyperbola>,
                                 AsImplicit,
                                 AsArc,
                                 AsArcPolynomial,
                                 AsRegression,
                                 AsChord,
                                 AsSpline>;

template <class T>
VectorOf<T> asked(const PlanarPiece& piece, const PlaceOf<T>& place) {
  return std::visit([&](const auto& shape) { return shape(place); }, piece);
}

}  // namespace loopbench::methods::manifold

/// Curve types for a window of the planar step. Each maps a spline point, at a time or a Jet of
/// time, to a point of the fitted curve.
#pragma once

#include <memory>
#include <variant>

#include "methods/smoothers/manifold/families/arc.hpp"
#include "methods/smoothers/manifold/families/implicit.hpp"
#include "methods/smoothers/manifold/families/polynomial.hpp"
#include "methods/smoothers/manifold/families/rational.hpp"
#include "methods/smoothers/manifold/families/sine.hpp"
#include "methods/smoothers/manifold/spline.hpp"

namespace loopbench::methods::manifold {

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

/// A parametric curve evaluated at the spline's arc length.
template <class Function>
struct ParametricPiece {
  Function curve;

  template <class T>
  VectorOf<T> operator()(const SplinePointOf<T>& position) const {
    return curve(position.distance);
  }
};
using ArcPiece = ParametricPiece<Arc>;
using ArcPolynomialPiece = ParametricPiece<ArcPolynomial>;

/// A cubic regression spline r(s) for the whole trajectory.
struct RegressionPiece {
  std::shared_ptr<const BSpline> curve;

  Vector3 operator()(const SplinePoint& position) const {
    return curve->at(position.distance).head<3>();
  }
  MotionJet operator()(const SplinePointJet& position) const {
    const auto out = curve->at(position.distance);
    return {out.value.head<3>(), out.first.head<3>(), out.second.head<3>()};
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
                                 ArcPolynomialPiece,
                                 RegressionPiece,
                                 ChordPiece,
                                 SplinePiece>;

template <class T>
VectorOf<T> value_of_piece(const PlanarPiece& piece, const SplinePointOf<T>& position) {
  return std::visit([&](const auto& shape) { return shape(position); }, piece);
}

}  // namespace loopbench::methods::manifold

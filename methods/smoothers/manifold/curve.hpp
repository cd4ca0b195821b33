/// What the manifold smoother hands back: spline, planar pieces and heights, asked by time.
#pragma once

#include "datasets/core/curve.hpp"
#include "methods/smoothers/manifold/pieces.hpp"
#include "methods/smoothers/manifold/spatial.hpp"
#include "methods/smoothers/manifold/strip.hpp"

namespace loopbench::manifold {

struct Parts {
  Vector3 base;  ///< position of the first node [m]
  Vector3 up;
  NodeSpline spline;
  std::optional<Strip<PlanarPiece, Vector3>> planar;  ///< none: y' is the spline's
  std::optional<Strip<Height, double>> spatial;       ///< none: z' is the spline's

  /// The spline with y' replaced, relative to `base`; `time` a double or its Jet.
  template <class T>
  VectorOf<T> planar_point(std::size_t edge, const T& time) const {
    const PlaceOf<T> place = spline.at(edge, time);
    if (!planar) return place.point;
    return planar->at(edge, time, [&](const PlanarPiece& piece) { return asked(piece, place); });
  }

  /// Both replaced.
  template <class T>
  VectorOf<T> point(std::size_t edge, const T& time) const {
    const VectorOf<T> out = planar_point(edge, time);
    if (!spatial) return out;
    const T own = along(up, out);
    const T height =
        spatial->at(edge, time, [&](const Height& piece) { return piece.over<T>(out, own); });
    return out + (height - own) * up;
  }
};

class ManifoldCurve final : public Curve {
 public:
  /// Two nodes or more. Orientation is theirs, on the great arc between them.
  ManifoldCurve(const Trajectory& nodes, Parts parts);

  double start() const override { return stamps_.front(); }
  double end() const override { return stamps_.back(); }

  using Curve::sample;
  void sample(std::span<const double> times, std::span<Pose> poses) const override;

  const std::vector<double>& stamps() const { return stamps_; }
  const Parts& parts() const { return parts_; }

  /// Position [m], velocity and acceleration, analytically, with the pieces of `edge` even at its
  /// ends: asked of both edges of a node, the jump there.
  Moving motion(std::size_t edge, double time) const;

 private:
  Rotation rotation(std::size_t edge, double time) const;

  struct Arm {
    Rotation start;
    Vector3 turn;  ///< tangent from `start` to the next node [rad]
  };
  std::vector<double> stamps_;
  std::vector<Arm> arms_;  ///< one for each edge: the logarithm is taken once
  Parts parts_;
};

}  // namespace loopbench::manifold

/// What the manifold smoother hands back: spline, planar pieces and heights, asked by time.
#pragma once

#include "datasets/core/curve.hpp"
#include "methods/smoothers/manifold/planar.hpp"
#include "methods/smoothers/manifold/spatial.hpp"

namespace loopbench::manifold {

struct Parts {
  Vector3 base;  ///< position of the first node [m]
  Vector3 up;
  NodeSpline spline;
  std::optional<Strip<PlanarPiece>> planar;  ///< none: y' is the spline's
  std::optional<Strip<Height>> spatial;      ///< none: z' is the spline's
};

class ManifoldCurve final : public Curve {
 public:
  /// Two nodes or more. Orientation is theirs, on the great arc between them.
  ManifoldCurve(const Trajectory& nodes, Parts parts);

  double start() const override { return stamps_.front(); }
  double end() const override { return stamps_.back(); }

  using Curve::sample;
  void sample(std::span<const double> times, std::span<Pose> poses) const override;

 private:
  Vector3 position(std::size_t edge, double time) const;
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

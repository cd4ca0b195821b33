/// A manifold curve asked where the reference is, not where its own spline is.
#pragma once

#include <memory>

#include "datasets/core/polyline.hpp"
#include "methods/smoothers/manifold/curve.hpp"

namespace loopbench {

class ReferenceAbscissa final : public Curve {
 public:
  /// `reference` in the world of `curve`. Not `used`: the curve as it is.
  ReferenceAbscissa(std::shared_ptr<const manifold::ManifoldCurve> curve,
                    Polyline reference,
                    bool used = true)
      : curve_(std::move(curve)), reference_(std::move(reference)), used_(used) {}

  double start() const override { return curve_->start(); }
  double end() const override { return curve_->end(); }

  /// y' = f(x'): x' is the reference's, so the output has that x' too; z' stays the estimate's.
  /// z' = q(x', y') without a planar step: only z' comes of the reference's x' and y'. Pieces that
  /// are no function of x' (arcs, splines, F(x', y') = 0), times outside the reference and all
  /// orientations stay what they are.
  using Curve::sample;
  void sample(std::span<const double> times, std::span<Pose> poses) const override;

 private:
  Vector3 point(std::size_t edge, double time, const Vector3& reference) const;

  std::shared_ptr<const manifold::ManifoldCurve> curve_;
  Polyline reference_;
  bool used_;
};

}  // namespace loopbench

/// A manifold curve evaluated at the reference's abscissa instead of the estimate's.
#pragma once

#include <memory>

#include "datasets/core/polyline.hpp"
#include "methods/smoothers/manifold/curve.hpp"

namespace loopbench::paper {

/// none: the unchanged curve. abscissa: fitted curves evaluated at the reference's x'. overwrite:
/// no fitted curve, x' of the spline replaced by the reference's: what the leak alone gives.
enum class ReferenceUse { none, abscissa, overwrite };

class ReferenceAbscissa final : public Curve {
 public:
  /// `reference` in the world frame of `curve`.
  ReferenceAbscissa(std::shared_ptr<const methods::manifold::ManifoldCurve> curve,
                    Polyline reference,
                    ReferenceUse use)
      : curve_(std::move(curve)), reference_(std::move(reference)), use_(use) {}

  double start() const override { return curve_->start(); }
  double end() const override { return curve_->end(); }

  /// y' = f(x'): x' is the reference's, so the output has that x', too; z' remains the estimate's.
  /// z' = q(x', y') without a planar step: only z' is computed from the reference's x' and y'.
  /// Pieces that are not a function of x' (arcs, splines, F(x', y') = 0), times outside the
  /// reference and all orientations are unchanged. With `overwrite`, the spline's point with x' of
  /// its window replaced by the reference's.
  using Curve::sample;
  void sample(std::span<const double> times, std::span<Pose> poses) const override;

 private:
  Vector3 point(std::size_t edge, double time, const Vector3& reference) const;

  std::shared_ptr<const methods::manifold::ManifoldCurve> curve_;
  Polyline reference_;
  ReferenceUse use_;
};

}  // namespace loopbench::paper

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

using methods::manifold::GraphPiece;
using methods::manifold::Height;
using methods::manifold::Parts;
using methods::manifold::PlanarPiece;

template <class Piece>
constexpr bool is_function_of_x = false;
template <class Function>
constexpr bool is_function_of_x<GraphPiece<Function>> = true;

inline Vector3 ReferenceAbscissa::point(std::size_t edge,
                                        double time,
                                        const Vector3& reference) const {
  const Parts& parts = curve_->parts();
  const methods::manifold::SplinePoint own = parts.spline.at(edge, time);
  const Vector3 projected = reference + parts.up.dot(own.point - reference) * parts.up;
  const methods::manifold::SplinePoint seen{projected, own.distance, own.time};
  const auto ask = [&](const PlanarPiece& piece) {
    return std::visit(
        [&](const auto& shape) -> Vector3 {
          if constexpr (is_function_of_x<std::remove_cvref_t<decltype(shape)>>) {
            const Vector3& x = shape.frame.x;
            if (use_ == ReferenceUse::abscissa) return shape(seen);
            return own.point + x.dot(reference - own.point) * x;
          } else {
            return use_ == ReferenceUse::abscissa ? shape(own) : own.point;
          }
        },
        piece);
  };
  const Vector3 planar = parts.planar ? parts.planar->at(edge, time, ask) : own.point;
  if (!parts.spatial) return planar;
  const Vector3& where = parts.planar ? planar : projected;
  const double height = parts.up.dot(planar);
  const auto over = [&](const Height& piece) { return piece.over<double>(where, height); };
  return planar + (parts.spatial->at(edge, time, over) - height) * parts.up;
}

inline void ReferenceAbscissa::sample(std::span<const double> times, std::span<Pose> poses) const {
  curve_->sample(times, poses);
  if (use_ == ReferenceUse::none) return;
  std::vector<double> known;
  std::vector<std::size_t> which;
  for (std::size_t k = 0; k < times.size(); ++k) {
    if (!(times[k] >= reference_.start() && times[k] <= reference_.end())) continue;
    known.push_back(times[k]);
    which.push_back(k);
  }
  const Trajectory reference = reference_.sample(known);
  const Vector3& base = curve_->parts().base;
  KnotSpan span(curve_->knots());
  for (std::size_t i = 0; i < which.size(); ++i) {
    const std::size_t edge = span.find(known[i]);
    const Vector3 seen = reference[i].world_from_body.translation - base;
    poses[which[i]].translation = base + point(edge, known[i], seen);
  }
}

}  // namespace loopbench::paper

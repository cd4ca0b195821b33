/// The penalised cubic smoothing spline, its stiffness chosen from the data.
#pragma once

#include "methods/method.hpp"
#include "methods/smoothers/penalised/reinsch.hpp"

namespace loopbench {

/// Minimises sum |y_i - f(t_i)|^2 + lambda int |f''|^2 over position, and the same over attitude
/// with great-arc distance and angular acceleration (unrolled.hpp: flattened, smoothed, rolled up
/// until it stands still). lambda by generalised cross-validation or restricted maximum likelihood,
/// for position and attitude apart. GCV is the default: on a motion that is smooth rather than a
/// random walk of velocity, the likelihood smooths too little (Wahba 1985). The curve is C2 in
/// position, C1 in attitude. White noise on the keyframes is what it removes; of a slow drift both
/// criteria see nothing. O(n) for each of some 35 values of lambda, O(1) amortised to ask. Source:
/// Reinsch 1967; Craven & Wahba 1979; Wahba 1985; Jupp & Kent 1987.
class SmoothingSpline final : public Smoother {
 public:
  enum class Axes { joint, each };
  enum class Turn { slerp, spline };
  struct Options {
    Criterion criterion = Criterion::gcv;
    std::optional<double> lambda_t = std::nullopt;  ///< [s^3]
    std::optional<double> lambda_r = std::nullopt;  ///< [s^3]
    Axes axes = Axes::joint;
    Turn rotation = Turn::spline;
  };
  explicit SmoothingSpline(const Options& options) : options_(options) {}

  std::optional<std::string> declines(const Problem& problem) const override;

  /// Counts: `lambda_t`, `lambda_r` [s^3] (`lambda_x`, `_y`, `_z` when axes are apart), `free_t`,
  /// `free_r` (degrees of freedom an axis, of n), `iterations` of the attitude. A note when the
  /// attitude does not settle.
  std::unique_ptr<const Curve> smooth(const Problem& problem, Report& report) const override;

 private:
  Options options_;
};

inline auto choices(SmoothingSpline::Axes) {
  return std::array{std::pair{"joint", SmoothingSpline::Axes::joint},
                    std::pair{"each", SmoothingSpline::Axes::each}};
}
inline auto choices(SmoothingSpline::Turn) {
  return std::array{std::pair{"slerp", SmoothingSpline::Turn::slerp},
                    std::pair{"spline", SmoothingSpline::Turn::spline}};
}

template <class Visit>
void fields(SmoothingSpline::Options& o, Visit visit) {
  visit("criterion", o.criterion, "how lambda is chosen");
  visit("lambda_t", o.lambda_t, "of position [s^3]; none: by the criterion", Above{0.0});
  visit("lambda_r", o.lambda_r, "of attitude [s^3]; none: by the criterion", Above{0.0});
  visit("axes", o.axes, "each: a lambda for each axis of the world, whose choice then matters");
  visit("rotation", o.rotation, "slerp: keyframes kept, great arcs; spline: smoothed too");
}

}  // namespace loopbench

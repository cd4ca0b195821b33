/// Penalised cubic smoothing spline with a penalty chosen from the data.
#pragma once

#include "methods/method.hpp"
#include "methods/smoothers/penalised/reinsch.hpp"

namespace loopbench::methods {

/// Minimises sum |y_i - f(t_i)|^2 + lambda int |f''|^2 over positions, and the same over rotations
/// with geodesic distance and angular acceleration (unrolled.hpp: unrolled to R^3, smoothed, rolled
/// back, iterated to convergence). lambda is chosen by generalised cross-validation or restricted
/// maximum likelihood, separately for position and rotation. GCV is the default: if the motion is
/// smooth rather than a random walk in velocity, the likelihood smooths too little (Wahba 1985).
/// The curve is C2 in position and C1 in rotation. The method removes white noise of the keyframes;
/// neither criterion detects slow drift. Keyframes that are too sparse for their motion look like
/// white noise: where the result leaves the odometry by more than five of its standard deviations,
/// and by more than its input does, it interpolates and says so in a note. O(n) for each of about
/// 35 values of lambda, O(1) amortised per query. Sources: Reinsch 1967; Craven & Wahba 1979; Wahba
/// 1985; Jupp & Kent 1987.
class SmoothingSpline final : public Smoother {
 public:
  struct Options {
    Criterion criterion = Criterion::gcv;
    std::optional<double> lambda_t = std::nullopt;  ///< [s^3]
    std::optional<double> lambda_r = std::nullopt;  ///< [s^3]
  };
  explicit SmoothingSpline(const Options& options) : options_(options) {}

  std::string why_declined(const Problem& problem) const override;

  /// Counts: `lambda_t`, `lambda_r` [s^3]; `dof_t`, `dof_r`, effective degrees of freedom of the
  /// fit per axis, at most n; `iterations` of the rotation fit. Adds a note when the rotation fit
  /// does not converge.
  std::unique_ptr<const Curve> smooth(const Problem& problem, Report& report) const override;

 private:
  Options options_;
};

template <class Visit>
void fields(SmoothingSpline::Options& o, Visit visit) {
  visit("criterion",
        o.criterion,
        "selection criterion of lambda: generalised cross-validation or restricted maximum "
        "likelihood");
  visit("lambda_t",
        o.lambda_t,
        "penalty on acceleration [s^3]; none: chosen by the criterion",
        GreaterThan{0.0});
  visit("lambda_r",
        o.lambda_r,
        "penalty on angular acceleration [s^3]; none: chosen by the criterion",
        GreaterThan{0.0});
}

}  // namespace loopbench::methods

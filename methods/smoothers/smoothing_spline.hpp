/// Penalised cubic smoothing spline with a penalty chosen from the data.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "datasets/core/factorisations.hpp"
#include "datasets/core/knot_curve.hpp"
#include "methods/method.hpp"
#include "methods/smoothers/penalised/reinsch.hpp"
#include "methods/smoothers/penalised/unrolled.hpp"
#include "methods/smoothers/runs/pose_runs.hpp"

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

/// Knot of a natural cubic spline: value and second derivative.
struct Knot {
  Vector3 value, curvature;
};

inline std::vector<Knot> knots_of(const Reinsch::Fit& fit) {
  std::vector<Knot> out;
  out.reserve(fit.values.size());
  for (std::size_t i = 0; i < fit.values.size(); ++i)
    out.push_back({fit.values[i], fit.curvatures[i]});
  return out;
}

inline Vector3 between(const Knot* knot, double u, double interval) {
  const double v = 1.0 - u;
  const double sixth = interval * interval / 6.0;
  return v * knot[0].value + u * knot[1].value -
         sixth * (v * u * ((1.0 + v) * knot[0].curvature + (1.0 + u) * knot[1].curvature));
}

class SmoothedCurve final : public KnotCurve {
 public:
  SmoothedCurve(std::vector<double> stamps,
                std::vector<Knot> points,
                UnrolledRotations path,
                std::vector<Knot> unrolled)
      : KnotCurve(std::move(stamps)),
        points_(std::move(points)),
        path_(std::move(path)),
        unrolled_(std::move(unrolled)) {}

 private:
  Pose evaluate(std::size_t i, double time) const override {
    const double interval = knots()[i + 1] - knots()[i];
    const double u = fraction(i, time);
    return {path_.roll(i, u, between(&unrolled_[i], u, interval)),
            between(&points_[i], u, interval)};
  }

  std::vector<Knot> points_;
  UnrolledRotations path_;
  std::vector<Knot> unrolled_;
};

struct Misfit {
  double translation = 0.0, rotation = 0.0;
};

/// RMS difference of the steps of a path from the odometry, in its standard deviations. O(edges).
inline Misfit misfit(const std::vector<Edge>& odometry,
                     const std::vector<Vector3>& points,
                     const std::vector<Rotation>& rotations) {
  Misfit out;
  for (const Edge& edge : odometry) {
    const Pose& measured = edge.from_from_to;
    const Rotation body_from_world = rotations[edge.from].conjugate();
    const Vector3 step = body_from_world * (points[edge.to] - points[edge.from]);
    const double angle = angle_between(measured.rotation, body_from_world * rotations[edge.to]);
    const Twist variances = inverse_of(edge.information).diagonal();
    out.translation += (measured.translation - step).squaredNorm() / variances.head<3>().sum();
    out.rotation += angle * angle / variances.tail<3>().sum();
  }
  const double edges = std::max(1.0, static_cast<double>(odometry.size()));
  return {std::sqrt(out.translation / edges), std::sqrt(out.rotation / edges)};
}

/// White noise that was removed brings the steps closer to the odometry, or leaves them within its
/// noise. Else the criterion took motion for noise: sparse keyframes do not resolve it.
inline bool takes_motion_for_noise(double before, double after) {
  constexpr double kMost = 5.0;  // simulated and real: at most 3.4 where motion is resolved
  return after > std::max(kMost, before);
}

inline void note_interpolated(Report& report, const char* what, double misfit) {
  report.notes.push_back(fmt::format(
      "{} interpolated: smoothed, they would leave the odometry by {:.2g} of its standard "
      "deviations, as keyframes that are too sparse to tell motion from noise",
      what,
      misfit));
}

inline std::string SmoothingSpline::why_declined(const Problem& problem) const {
  return too_few_keyframes(problem.keyframes, 3);
}

inline std::unique_ptr<const Curve> SmoothingSpline::smooth(const Problem& problem,
                                                            Report& report) const {
  const std::vector<double> times = stamps(problem.keyframes);
  const auto size = static_cast<double>(times.size());
  const Reinsch reinsch(times);

  const std::vector<Vector3> points = positions_of(problem.keyframes);
  const std::vector<Rotation> rotations = rotations_of(problem.keyframes);
  const Misfit before = misfit(problem.odometry, points, rotations);
  double lambda_t = options_.lambda_t ? *options_.lambda_t
                                      : select_lambda(reinsch, times, points, options_.criterion);
  Reinsch::Fit positions = reinsch.fit(points, lambda_t);
  const double misfit_t = misfit(problem.odometry, positions.values, rotations).translation;
  if (!options_.lambda_t && takes_motion_for_noise(before.translation, misfit_t)) {
    note_interpolated(report, "positions", misfit_t);
    lambda_t = interpolating_lambda(times);
    positions = reinsch.fit(points, lambda_t);
  }
  report.count("lambda_t", lambda_t);
  report.count("dof_t", size - positions.residual_dof);

  double lambda = 0.0;
  const auto smoothed = [&](std::optional<double> given) {
    // The first rounds change the unrolled data; after kChoices rounds lambda is kept.
    int rounds = 0;
    lambda = given.value_or(0.0);
    return smoothed_rotations(rotations, [&](const std::vector<Vector3>& flat) {
      constexpr int kChoices = 3;
      if (!given && rounds++ < kChoices)
        lambda = select_lambda(reinsch, times, flat, options_.criterion);
      return reinsch.fit(flat, lambda);
    });
  };
  auto rotation = smoothed(options_.lambda_r);
  const double misfit_r = misfit(problem.odometry, points, rotation.path.base()).rotation;
  if (!options_.lambda_r && takes_motion_for_noise(before.rotation, misfit_r)) {
    note_interpolated(report, "rotations", misfit_r);
    rotation = smoothed(interpolating_lambda(times));
  }
  report.count("lambda_r", lambda);
  report.count("dof_r", size - rotation.fit.residual_dof);
  report.count("iterations", rotation.iterations);
  if (!rotation.converged) report.notes.push_back("the rotation fit did not converge");
  return std::make_unique<SmoothedCurve>(
      times, knots_of(positions), rotation.path, knots_of(rotation.fit));
}

}  // namespace loopbench::methods

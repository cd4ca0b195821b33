#include "methods/smoothers/smoothing_spline.hpp"

#include <utility>

#include "datasets/core/knot_curve.hpp"
#include "methods/smoothers/penalised/unrolled.hpp"
#include "methods/smoothers/runs/pose_runs.hpp"

namespace loopbench::methods {
namespace {

/// Knot of a natural cubic spline: value and second derivative.
struct Knot {
  Vector3 value, curvature;
};

std::vector<Knot> knots_of(const Reinsch::Fit& fit) {
  std::vector<Knot> out;
  out.reserve(fit.values.size());
  for (std::size_t i = 0; i < fit.values.size(); ++i)
    out.push_back({fit.values[i], fit.curvatures[i]});
  return out;
}

Vector3 between(const Knot* knot, double u, double interval) {
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

}  // namespace

std::string SmoothingSpline::why_declined(const Problem& problem) const {
  return too_few_keyframes(problem.keyframes, 3);
}

std::unique_ptr<const Curve> SmoothingSpline::smooth(const Problem& problem, Report& report) const {
  const std::vector<double> times = stamps(problem.keyframes);
  const auto size = static_cast<double>(times.size());
  const Reinsch reinsch(times);

  const std::vector<Vector3> points = positions_of(problem.keyframes);
  const double lambda_t = options_.lambda_t
                              ? *options_.lambda_t
                              : select_lambda(reinsch, times, points, options_.criterion);
  report.count("lambda_t", lambda_t);
  const Reinsch::Fit positions = reinsch.fit(points, lambda_t);
  report.count("dof_t", size - positions.residual_dof);

  // The first rounds change the unrolled data; after kChoices rounds lambda is kept.
  double lambda = options_.lambda_r.value_or(0.0);
  int rounds = 0;
  const auto rotation =
      smoothed_rotations(rotations_of(problem.keyframes), [&](const std::vector<Vector3>& flat) {
        constexpr int kChoices = 3;
        if (!options_.lambda_r && rounds++ < kChoices) {
          lambda = select_lambda(reinsch, times, flat, options_.criterion);
        }
        return reinsch.fit(flat, lambda);
      });
  report.count("lambda_r", lambda);
  report.count("dof_r", size - rotation.fit.residual_dof);
  report.count("iterations", rotation.iterations);
  if (!rotation.converged) report.notes.push_back("the rotation fit did not converge");
  return std::make_unique<SmoothedCurve>(
      times, knots_of(positions), rotation.path, knots_of(rotation.fit));
}

}  // namespace loopbench::methods

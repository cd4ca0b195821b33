#include "methods/smoothers/trend_filter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "datasets/core/polyline.hpp"
#include "methods/smoothers/penalised/trend.hpp"
#include "methods/smoothers/penalised/unrolled.hpp"
#include "methods/smoothers/runs/parts.hpp"

namespace loopbench::methods {
namespace {

struct TrendChoice {
  Trend::Fit fit;
  double lambda = 0.0;  ///< [unit times mean intervals]
  int iterations = 0;
  bool converged = true;
};

double extent_of(const std::vector<Vector3>& y) {
  double out = 0.0;
  for (const Vector3& value : y) out = std::max(out, (value - y.front()).norm());
  return out;
}

/// Returns log GCV, or BIC / N for a refitted (unpenalised) fit; lower is better.
double score(const std::vector<Vector3>& y, const Trend::Fit& fit, double extent, bool refitted) {
  double squares = 0.0;
  for (std::size_t i = 0; i < y.size(); ++i) squares += (y[i] - fit.values[i]).squaredNorm();
  const auto size = 3.0 * static_cast<double>(y.size());
  const auto used = 3.0 * static_cast<double>(fit.kinks.size() + 2) / size;
  // Residuals at rounding level count as equal, so that the fit with fewer kinks is preferred.
  const double rounding = 1e-9 * extent;
  const double fidelity = std::log(squares / size + rounding * rounding + 1e-300);
  if (refitted) return fidelity + used * std::log(size);
  if (used >= 1.0)
    return std::numeric_limits<double>::infinity();  // no residual degrees of freedom
  return fidelity - 2.0 * std::log(1.0 - used);
}

constexpr int kSteps = 24;  // number of values of lambda, four per decade

/// The regression line, which is the fit for every lambda >= trend.min_lambda_of_line(y).
Trend::Fit line(const Trend& trend, const std::vector<Vector3>& y) {
  return {trend.refitted(y, {}), {}, 0, true};
}

TrendChoice choose_fit(const Trend& trend,
                       const std::vector<Vector3>& y,
                       const TrendFilter::Options& options) {
  const double extent = extent_of(y);
  const double straight = trend.min_lambda_of_line(y);
  if (straight <= 1e-9 * extent) return {line(trend, y)};
  // lambda lies on a fixed lattice, so that rounding does not change the choice.
  const double top = std::pow(10.0, std::ceil(4.0 * std::log10(straight)) / 4.0);

  TrendChoice best{line(trend, y), top};
  double lowest = score(y, best.fit, extent, options.refit);
  const auto fitted = [&](double lambda) {
    Trend::Fit fit = trend.fit(y, lambda);
    best.iterations += fit.iterations;
    best.converged = best.converged && fit.converged;
    if (options.refit) trend.refit(y, fit);
    return fit;
  };
  if (options.share) {
    best.lambda = *options.share * straight;
    best.fit = fitted(best.lambda);
    return best;
  }
  for (int k = 1; k <= kSteps; ++k) {
    const double lambda = top * std::pow(10.0, -k / 4.0);
    Trend::Fit fit = fitted(lambda);
    if (options.refit && 2 * fit.kinks.size() > y.size()) break;
    const double value = score(y, fit, extent, options.refit);
    if (value >= lowest) continue;
    lowest = value;
    best.lambda = lambda;
    best.fit = std::move(fit);
  }
  return best;
}

}  // namespace

std::string TrendFilter::why_declined(const Problem& problem) const {
  return too_few_keyframes(problem.keyframes, 3);
}

std::unique_ptr<const Curve> TrendFilter::smooth(const Problem& problem, Report& report) const {
  const std::vector<double> times = stamps(problem.keyframes);
  const Trend trend(times);
  Trajectory out = problem.keyframes;
  const TrendChoice positions = choose_fit(trend, positions_of(problem.keyframes), options_);
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i].world_from_body.translation = positions.fit.values[i];
  }
  report.count("kinks_t", static_cast<double>(positions.fit.kinks.size()));
  report.count("lambda_t", positions.lambda * trend.interval());
  int iterations = positions.iterations;
  bool converged = positions.converged;

  TrendChoice rotation_choice;
  int rounds = 0;
  // The first rounds change the unrolled data; after kChoices rounds lambda, or the kinks, are
  // kept.
  const auto fit_points = [&](const std::vector<Vector3>& flat) {
    constexpr int kChoices = 2;
    if (rounds++ < kChoices) {
      rotation_choice = choose_fit(trend, flat, options_);
      iterations += rotation_choice.iterations;
      converged = converged && rotation_choice.converged;
    } else if (options_.refit || rotation_choice.fit.kinks.empty()) {
      rotation_choice.fit.values = trend.refitted(flat, rotation_choice.fit.kinks);
    } else {
      rotation_choice.fit = trend.fit(flat, rotation_choice.lambda);
      iterations += rotation_choice.fit.iterations;
    }
    return rotation_choice.fit;
  };
  const double tolerance = options_.refit ? 1e-11 : 1e-2 * Trend::kTolerance;
  const auto rotation = smoothed_rotations(rotations_of(problem.keyframes), fit_points, tolerance);
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i].world_from_body.rotation = rotation.path.roll(i, 0.0, rotation.fit.values[i]);
  }
  report.count("kinks_r", static_cast<double>(rotation.fit.kinks.size()));
  report.count("lambda_r", rotation_choice.lambda * trend.interval());
  if (!rotation.converged) report.notes.push_back("the rotation fit did not converge");
  report.count("iterations", iterations);
  if (!converged) report.notes.push_back("an interior-point solve stopped before convergence");
  return std::make_unique<Polyline>(std::move(out));
}

}  // namespace loopbench::methods

#include "methods/smoothers/trend_filter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "datasets/core/polyline.hpp"
#include "methods/smoothers/parts.hpp"
#include "methods/smoothers/penalised/trend.hpp"
#include "methods/smoothers/penalised/unrolled.hpp"

namespace loopbench {
namespace {

struct Chosen {
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

/// log of GCV, or BIC / N when the fit is not pulled by a penalty; less is better.
double score(const std::vector<Vector3>& y, const Trend::Fit& fit, double extent, bool refitted) {
  double squares = 0.0;
  for (std::size_t i = 0; i < y.size(); ++i) squares += (y[i] - fit.values[i]).squaredNorm();
  const auto size = 3.0 * static_cast<double>(y.size());
  const auto used = 3.0 * static_cast<double>(fit.kinks.size() + 2) / size;
  // What is exact to rounding is exact: there, fewer kinks win.
  const double rounding = 1e-9 * extent;
  const double fidelity = std::log(squares / size + rounding * rounding + 1e-300);
  if (refitted) return fidelity + used * std::log(size);
  if (used >= 1.0) return std::numeric_limits<double>::infinity();  // nothing is left to judge by
  return fidelity - 2.0 * std::log(1.0 - used);
}

constexpr int kSteps = 24;  // of the path of lambda, four a decade

/// The straight line of regression, which every lambda from `straight_from` up gives.
Trend::Fit line(const Trend& trend, const std::vector<Vector3>& y) {
  return {trend.refitted(y, {}), {}, 0, true};
}

Chosen chosen(const Trend& trend,
              const std::vector<Vector3>& y,
              const TrendFilter::Options& options) {
  const Trend::Settings settings{options.tolerance, options.max_iterations};
  const double extent = extent_of(y);
  const double straight = trend.straight_from(y);
  if (straight <= 1e-9 * extent) return {line(trend, y)};
  // On a lattice, so that rounding decides nothing.
  const double top = std::pow(10.0, std::ceil(4.0 * std::log10(straight)) / 4.0);

  Chosen best{line(trend, y), top};
  double least = score(y, best.fit, extent, options.refit);
  const auto fitted = [&](double lambda) {
    Trend::Fit fit = trend.fit(y, lambda, settings);
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
    const double now = score(y, fit, extent, options.refit);
    if (now >= least) continue;
    least = now;
    best.lambda = lambda;
    best.fit = std::move(fit);
  }
  return best;
}

}  // namespace

std::optional<std::string> TrendFilter::declines(const Problem& problem) const {
  if (problem.keyframes.size() < 3) return "fewer than 3 keyframes bend nowhere";
  return std::nullopt;
}

std::unique_ptr<const Curve> TrendFilter::smooth(const Problem& problem, Report& report) const {
  const std::vector<double> times = stamps(problem.keyframes);
  const Trend trend(times);
  Trajectory out = problem.keyframes;
  const Chosen positions = chosen(trend, places(problem.keyframes), options_);
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i].world_from_body.translation = positions.fit.values[i];
  }
  report.count("kinks_t", static_cast<double>(positions.fit.kinks.size()));
  report.count("lambda_t", positions.lambda * trend.interval());
  int iterations = positions.iterations;
  bool converged = positions.converged;

  if (options_.rotation == Turn::filtered) {
    Chosen attitude;
    int rounds = 0;
    // The first rounds move the data's flat image; then lambda, or the kinks, stand.
    const auto fit_points = [&](const std::vector<Vector3>& flat) {
      constexpr int kChoices = 2;
      if (rounds++ < kChoices) {
        attitude = chosen(trend, flat, options_);
        iterations += attitude.iterations;
        converged = converged && attitude.converged;
      } else if (options_.refit || attitude.fit.kinks.empty()) {
        attitude.fit.values = trend.refitted(flat, attitude.fit.kinks);
      } else {
        attitude.fit =
            trend.fit(flat, attitude.lambda, {options_.tolerance, options_.max_iterations});
        iterations += attitude.fit.iterations;
      }
      return attitude.fit;
    };
    const double still = options_.refit ? 1e-11 : 1e-2 * options_.tolerance;
    const auto turned = smoothed_rotations(attitudes(problem.keyframes), fit_points, still);
    for (std::size_t i = 0; i < out.size(); ++i) {
      out[i].world_from_body.rotation = turned.path.rolled(i, 0.0, turned.fit.values[i]);
    }
    report.count("kinks_r", static_cast<double>(turned.fit.kinks.size()));
    report.count("lambda_r", attitude.lambda * trend.interval());
    if (!turned.settled) report.notes.push_back("the attitude did not settle");
  }
  report.count("iterations", iterations);
  if (!converged) report.notes.push_back("an interior-point solve ended before it converged");
  return std::make_unique<Polyline>(std::move(out));
}

}  // namespace loopbench

#include "methods/smoothers/trend_filter.hpp"

#include <algorithm>
#include <cmath>

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

double bic(const std::vector<Vector3>& y, const Trend::Fit& fit, double extent) {
  double squares = 0.0;
  for (std::size_t i = 0; i < y.size(); ++i) squares += (y[i] - fit.values[i]).squaredNorm();
  const auto size = 3.0 * static_cast<double>(y.size());
  const auto free = 3.0 * static_cast<double>(fit.kinks.size() + 2);
  // What is exact to rounding is exact: there, fewer kinks win.
  const double rounding = 1e-9 * extent;
  return size * std::log(squares / size + rounding * rounding + 1e-300) + free * std::log(size);
}

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

  Trend::State state;
  Chosen best{line(trend, y), top};
  double least = bic(y, best.fit, extent);
  const auto fitted = [&](double lambda) {
    Trend::Fit fit = trend.fit(y, lambda, settings, state);
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
  for (int k = 1; k <= 16; ++k) {
    const double lambda = top * std::pow(10.0, -k / 4.0);
    Trend::Fit fit = fitted(lambda);
    if (2 * fit.kinks.size() > y.size()) break;
    const double score = bic(y, fit, extent);
    if (score >= least) continue;
    least = score;
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
    // The first rounds move the data's flat image; then the kinks stand and the values settle.
    const auto turned =
        smoothed_rotations(attitudes(problem.keyframes), [&](const std::vector<Vector3>& flat) {
          constexpr int kChoices = 2;
          if (rounds++ < kChoices || !options_.refit) {
            TrendFilter::Options same = options_;
            if (rounds > kChoices) same.share = attitude.lambda / trend.straight_from(flat);
            attitude = chosen(trend, flat, same);
            iterations += attitude.iterations;
            converged = converged && attitude.converged;
          } else {
            attitude.fit.values = trend.refitted(flat, attitude.fit.kinks);
          }
          return attitude.fit;
        });
    for (std::size_t i = 0; i < out.size(); ++i) {
      out[i].world_from_body.rotation = turned.path.rolled(i, 0.0, turned.fit.values[i]);
    }
    report.count("kinks_r", static_cast<double>(turned.fit.kinks.size()));
    report.count("lambda_r", attitude.lambda * trend.interval());
    if (!turned.settled) report.notes.push_back("the attitude did not settle");
  }
  report.count("iterations", iterations);
  if (!converged) report.notes.push_back("ADMM ended before it converged");
  return std::make_unique<Polyline>(std::move(out));
}

}  // namespace loopbench

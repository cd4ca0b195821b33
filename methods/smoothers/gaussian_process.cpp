#include "methods/smoothers/gaussian_process.hpp"

#include <limits>
#include <optional>
#include <utility>

#include "datasets/core/knot_curve.hpp"
#include "datasets/core/median_interval.hpp"
#include "datasets/core/polyline.hpp"
#include "methods/smoothers/gp/posterior.hpp"
#include "methods/smoothers/penalised/reinsch.hpp"
#include "methods/smoothers/penalised/unrolled.hpp"
#include "methods/smoothers/runs/pose_runs.hpp"

namespace loopbench::methods {
namespace {

constexpr std::size_t kMinKeyframes = 3;

/// Hyperparameters fixed by the user; empty values are estimated. Powers are per mean interval.
struct GpFixedParameters {
  std::optional<double> sigma_t, sigma_r, power_t, power_r;
};

/// Result of estimate_parameters(): coordinate descent of -log evidence on a lattice of exponents
/// (10^(k / 8)), with steps of half a decade at first and then halved steps. `states` is the
/// linearisation point. About 50 eliminations of O(n).
struct GpEstimate {
  GpParameters parameters;
  int evaluations = 0;
};

double round_to_lattice(double value) {
  return std::pow(10.0, std::round(8.0 * std::log10(value)) / 8.0);
}

struct ScalarNoise {
  double sigma, power;
};

/// Estimates noise and power of translation or rotation from the smoothing spline.
ScalarNoise noise_from_spline(const std::vector<double>& times,
                              const std::vector<Vector3>& y,
                              Criterion criterion) {
  double extent = 1e-3;
  for (const Vector3& value : y) extent = std::max(extent, (value - y.front()).norm());
  const Reinsch reinsch(times);
  // Above this bound the normal equations lose precision.
  const double lambda = std::min(select_lambda(reinsch, times, y, criterion), 1e6);
  const double energy = reinsch.fit(y, lambda).energy.sum();
  const double freedom = 3.0 * static_cast<double>(y.size() - 2);
  const double sigma = round_to_lattice(std::max(std::sqrt(energy / freedom), 1e-9 * extent));
  return {sigma, round_to_lattice(sigma * sigma / lambda)};
}

/// Returns initial hyperparameters from the scalar form of the model, the smoothing spline
/// (reinsch.hpp), with the restricted likelihood or GCV. For sparse keyframes the evidence has
/// several local maxima, so both criteria should be tried.
GpParameters initial_parameters(const Trajectory& measured,
                                Criterion criterion,
                                const GpFixedParameters& given) {
  std::vector<double> times = stamps(measured);
  const double first = times.front();
  const double interval = (times.back() - first) / static_cast<double>(times.size() - 1);
  for (double& time : times) time = (time - first) / interval;
  const std::vector<Rotation> rotations = rotations_of(measured);
  const UnrolledRotations path(rotations);
  std::vector<Vector3> unrolled;
  for (std::size_t i = 0; i < rotations.size(); ++i)
    unrolled.push_back(path.unroll(i, rotations[i]));
  const ScalarNoise t = noise_from_spline(times, positions_of(measured), criterion);
  const ScalarNoise r = noise_from_spline(times, unrolled, criterion);
  return {given.sigma_t.value_or(t.sigma),
          given.sigma_r.value_or(r.sigma),
          given.power_t.value_or(t.power),
          given.power_r.value_or(r.power)};
}

GpEstimate estimate_parameters(const GpPosterior& posterior,
                               const GpPosterior::States& states,
                               const GpParameters& start,
                               const GpFixedParameters& given) {
  constexpr double kMinDecrease = 1e-3;  // [nats]; a smaller difference may be rounding
  constexpr int kFarthest = 32;          // lattice steps: four decades from the start
  GpEstimate out{start, 1};
  double lowest = posterior.negative_evidence(states, start);
  struct Coordinate {
    double GpParameters::*value;
    bool fixed;
    int moved = 0;
  };
  std::array<Coordinate, 4> coordinates{
      Coordinate{&GpParameters::power_t, given.power_t.has_value()},
      Coordinate{&GpParameters::sigma_t, given.sigma_t.has_value()},
      Coordinate{&GpParameters::power_r, given.power_r.has_value()},
      Coordinate{&GpParameters::sigma_r, given.sigma_r.has_value()}};
  for (int step = 4; step >= 1; step /= 2) {
    for (bool improved = true; improved;) {
      improved = false;
      for (Coordinate& coordinate : coordinates) {
        if (coordinate.fixed) continue;
        for (const int change : {step, -step}) {
          if (std::abs(coordinate.moved + change) > kFarthest) continue;
          GpParameters trial = out.parameters;
          trial.*coordinate.value =
              start.*coordinate.value * std::pow(10.0, (coordinate.moved + change) / 8.0);
          const double value = posterior.negative_evidence(states, trial);
          ++out.evaluations;
          if (!(value < lowest - kMinDecrease)) continue;
          lowest = value;
          out.parameters = trial;
          coordinate.moved += change;
          improved = true;
          break;
        }
      }
    }
  }
  return out;
}

class GpCurve final : public KnotCurve {
 public:
  GpCurve(std::vector<double> stamps, const GpPosterior& posterior, std::vector<GpState> states)
      : KnotCurve(std::move(stamps)), states_(std::move(states)) {
    // Derivatives are scaled by the interval length, so the weights are those of a unit interval.
    for (std::size_t i = 0; i + 1 < states_.size(); ++i) {
      Interval each;
      each.to = local_state(states_[i], states_[i + 1]).value;
      each.from[0].setZero();
      each.from[1] = posterior.interval_of(i) * states_[i].rate;
      each.to[1] *= posterior.interval_of(i);
      intervals_.push_back(each);
    }
  }

 private:
  Pose evaluate(std::size_t i, double time) const override {
    const auto weights = Prior::between(fraction(i, time));
    Twist xi = Twist::Zero();
    for (int a = 0; a < 2; ++a) {
      const auto index = static_cast<std::size_t>(a);
      xi += weights.from[a] * intervals_[i].from[index] + weights.to[a] * intervals_[i].to[index];
    }
    return normalized(states_[i].pose * exp_se3(xi));
  }

  struct Interval {
    std::array<Twist, 2> from, to;  ///< local states at either end
  };
  std::vector<GpState> states_;
  std::vector<Interval> intervals_;
};

}  // namespace

std::unique_ptr<const Curve> GaussianProcess::smooth_segment(const Trajectory& keyframes,
                                                             Report& report) const {
  const GpPosterior posterior(keyframes);
  const double unit = std::pow(posterior.interval(), 3);
  const auto per_interval = [&](const std::optional<double>& power) {
    return power ? std::optional<double>(*power * unit) : std::nullopt;
  };
  const GpFixedParameters given{options_.sigma_t,
                                options_.sigma_r,
                                per_interval(options_.power_t),
                                per_interval(options_.power_r)};
  auto states = posterior.initial_states();
  int iterations = 0, evaluations = 0;
  GpParameters parameters = report.time("evidence", [&] {
    GpParameters best;
    double lowest = std::numeric_limits<double>::infinity();
    for (const Criterion criterion : {Criterion::reml, Criterion::gcv}) {
      const GpParameters start = initial_parameters(keyframes, criterion, given);
      auto trial = posterior.initial_states();
      iterations += posterior.solve(trial, start);
      const GpEstimate chosen = estimate_parameters(posterior, trial, start, given);
      evaluations += chosen.evaluations;
      iterations += posterior.solve(trial, chosen.parameters);
      const double evidence = posterior.negative_evidence(trial, chosen.parameters);
      if (!(evidence < lowest - 1e-3)) continue;  // a smaller difference may be rounding
      lowest = evidence;
      best = chosen.parameters;
      states = std::move(trial);
    }
    const GpEstimate chosen = estimate_parameters(posterior, states, best, given);
    evaluations += chosen.evaluations;
    return chosen.parameters;
  });
  iterations += report.time("solve", [&] { return posterior.solve(states, parameters); });
  report.count("sigma_t", parameters.sigma_t);
  report.count("sigma_r", parameters.sigma_r);
  report.count("power_t", parameters.power_t / unit);
  report.count("power_r", parameters.power_r / unit);
  report.count("iterations", iterations);
  report.count("evaluations", evaluations);
  if (options_.covariances) report.covariances = posterior.covariances(states, parameters);
  return std::make_unique<GpCurve>(stamps(keyframes), posterior, std::move(states));
}

std::string GaussianProcess::why_declined(const Problem& problem) const {
  return too_few_keyframes(problem.keyframes, kMinKeyframes);
}

std::unique_ptr<const Curve> GaussianProcess::smooth(const Problem& problem, Report& report) const {
  // The covariance of the prior grows with the third power of the interval: for 50 medians it is
  // 1e5 times the usual one. Beyond that precision is lost, and the prior does not constrain such a
  // gap anyway.
  constexpr double kLongest = 50.0;
  constexpr double kShortest = 0.05;
  const Trajectory& keyframes = problem.keyframes;
  const double median = median_interval(keyframes);
  const auto segments = runs_without_breaks(keyframes.size(), [&](std::size_t i) {
    const double interval = keyframes[i + 1].stamp - keyframes[i].stamp;
    return interval > kLongest * median || interval < kShortest * median;
  });
  return smooth_segments(
      keyframes,
      segments,
      "intervals above 50 or below 0.05 times the median",
      report,
      [&](const Trajectory& part, Report& part_report) -> std::unique_ptr<const Curve> {
        if (part.size() < kMinKeyframes) return std::make_unique<Polyline>(part);
        return smooth_segment(part, part_report);
      });
}

}  // namespace loopbench::methods

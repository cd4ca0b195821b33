#include "methods/smoothers/gaussian_process.hpp"

#include <limits>
#include <utility>

#include "datasets/core/knot_span.hpp"
#include "datasets/core/polyline.hpp"
#include "methods/smoothers/gp/evidence.hpp"
#include "methods/smoothers/pose_runs.hpp"

namespace loopbench::methods {
namespace {

template <int P>
class GpCurve final : public Curve {
 public:
  GpCurve(std::vector<double> stamps,
          const GpPosterior<P>& posterior,
          std::vector<GpState<P>> states)
      : stamps_(std::move(stamps)), states_(std::move(states)) {
    // Derivatives are scaled by the interval length, so the weights are those of a unit interval.
    for (std::size_t i = 0; i + 1 < states_.size(); ++i) {
      Interval each;
      each.to = local_state(states_[i], states_[i + 1]).value;
      each.from[0].setZero();
      double power = 1.0;
      for (std::size_t a = 1; a < P; ++a) {
        power *= posterior.interval_of(i);
        each.from[a] = power * states_[i].rates[a - 1];
        each.to[a] *= power;
      }
      intervals_.push_back(each);
    }
  }

  double start() const override { return stamps_.front(); }
  double end() const override { return stamps_.back(); }

  using Curve::sample;
  void sample(std::span<const double> times, std::span<Pose> poses) const override {
    KnotSpan span(stamps_);
    for (std::size_t k = 0; k < times.size(); ++k) {
      const std::size_t i = span.find(times[k]);
      const double s = (times[k] - stamps_[i]) / (stamps_[i + 1] - stamps_[i]);
      const auto weights = Prior<P>::between(s);
      Twist xi = Twist::Zero();
      for (int a = 0; a < P; ++a) {
        const auto index = static_cast<std::size_t>(a);
        xi += weights.from[a] * intervals_[i].from[index] + weights.to[a] * intervals_[i].to[index];
      }
      poses[k] = normalized(states_[i].pose * exp_se3(xi));
    }
  }

 private:
  struct Interval {
    std::array<Twist, P> from, to;  ///< local states at either end
  };
  std::vector<double> stamps_;
  std::vector<GpState<P>> states_;
  std::vector<Interval> intervals_;
};

}  // namespace

template <int P>
std::unique_ptr<const Curve> GaussianProcess::smooth_with(const Trajectory& keyframes,
                                                          Report& report) const {
  const GpPosterior<P> posterior(keyframes);
  const double unit = std::pow(posterior.interval(), 2 * P - 1);
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
      const GpParameters start = initial_parameters(keyframes, P, criterion, given);
      auto trial = posterior.initial_states();
      iterations += posterior.solve(trial, start);
      const GpEstimate chosen = estimate_parameters<P>(posterior, trial, start, given);
      evaluations += chosen.evaluations;
      iterations += posterior.solve(trial, chosen.parameters);
      const double evidence = posterior.negative_evidence(trial, chosen.parameters);
      if (!(evidence < lowest - 1e-3)) continue;  // a smaller difference may be rounding
      lowest = evidence;
      best = chosen.parameters;
      states = std::move(trial);
    }
    const GpEstimate chosen = estimate_parameters<P>(posterior, states, best, given);
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
  return std::make_unique<GpCurve<P>>(stamps(keyframes), posterior, std::move(states));
}

std::string GaussianProcess::why_declined(const Problem& problem) const {
  if (problem.keyframes.size() >= min_keyframes()) return "";
  return std::to_string(problem.keyframes.size()) + " keyframes, fewer than " +
         std::to_string(min_keyframes());
}

std::size_t GaussianProcess::min_keyframes() const {
  return options_.prior == Prior::velocity ? 3 : 4;
}

std::unique_ptr<const Curve> GaussianProcess::smooth(const Problem& problem, Report& report) const {
  // The covariance of the prior grows with the third (fifth) power of the interval: for 50 medians
  // it is 1e5 (3e8) times the usual one. Beyond that precision is lost, and the prior does not
  // constrain such a gap anyway.
  constexpr double kLongest = 50.0;
  constexpr double kShortest = 0.05;
  const Trajectory& keyframes = problem.keyframes;
  const double median = median_interval(keyframes);
  const auto segments = runs_without_breaks(keyframes.size(), [&](std::size_t i) {
    const double interval = keyframes[i + 1].stamp - keyframes[i].stamp;
    return interval > kLongest * median || interval < kShortest * median;
  });
  const std::size_t lowest = min_keyframes();
  return smooth_segments(
      keyframes,
      segments,
      "intervals above 50 or below 0.05 times the median",
      report,
      [&](const Trajectory& part, Report& part_report) -> std::unique_ptr<const Curve> {
        if (part.size() < lowest) return std::make_unique<Polyline>(part);
        if (options_.prior == Prior::velocity) return smooth_with<2>(part, part_report);
        return smooth_with<3>(part, part_report);
      });
}

}  // namespace loopbench::methods

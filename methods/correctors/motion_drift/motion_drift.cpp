#include "methods/correctors/motion_drift/motion_drift.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "methods/correctors/chain.hpp"
#include "methods/correctors/dual.hpp"
#include "methods/correctors/motion_drift/evidence.hpp"
#include "methods/correctors/motion_drift/shared_drift.hpp"
#include "methods/correctors/scale_drift.hpp"

namespace loopbench::methods {
namespace {

/// Regressors of noise and drift without given values. Speed is not one of them: for evenly spaced
/// keyframes it is proportional to distance.
bool is_default(Regressor regressor) {
  return regressor != Regressor::edge && regressor != Regressor::speed;
}

void add_noise(MotionModel& out, const MotionDrift::Options& o) {
  for (const Component component : {Component::translation, Component::rotation}) {
    for (const Regressor regressor : kRegressors) {
      const auto& given =
          o.noise[static_cast<std::size_t>(component)][static_cast<std::size_t>(regressor)];
      if (given ? *given == 0.0 : !is_default(regressor)) continue;
      out.push_back(
          {TermKind::noise, component, regressor, given.value_or(0.0), given.has_value()});
    }
  }
}

void add_drift(MotionModel& out, const MotionDrift::Options& o, bool planar) {
  for (const Component component : {Component::translation, Component::rotation}) {
    for (const Regressor regressor : kRegressors) {
      const auto& given =
          o.drift[static_cast<std::size_t>(component)][static_cast<std::size_t>(regressor)];
      const bool has_drift = component == Component::rotation && is_default(regressor);
      if (given ? *given == 0.0 : !has_drift) continue;
      Term term{TermKind::drift, component, regressor, given.value_or(0.0), given.has_value()};
      term.value *= term.value;
      if (component == Component::translation) {
        out.push_back(term);
        continue;
      }
      // One term per axis: odometry drift is often much larger about one axis than about the
      // others.
      for (term.axis = planar ? 2 : 0; term.axis < 3; ++term.axis) out.push_back(term);
    }
  }
}

MotionModel model_of(const MotionDrift::Options& o, bool planar) {
  MotionModel out;
  add_noise(out, o);
  const bool calibrated = std::ranges::any_of(out, &Term::given);
  if (!calibrated) {
    out.push_back({TermKind::stated, Component::rotation, Regressor::edge});
  }
  add_drift(out, o, planar);
  for (const Component component : {Component::translation, Component::rotation}) {
    const std::optional<double>& given = o.closures[static_cast<std::size_t>(component)];
    out.push_back(
        {TermKind::closures, component, Regressor::edge, given.value_or(1.0), given.has_value()});
  }
  return out;
}

/// At most `most` evenly spaced indices of 0 .. size - 1.
std::vector<std::size_t> evenly_spaced(std::size_t size, std::size_t most) {
  std::vector<std::size_t> out;
  const std::size_t count = std::min(size, most);
  for (std::size_t i = 0; i < count; ++i) out.push_back(i * size / count);
  return out;
}

/// Posterior probability of drift.
double drift_probability(const MotionPrior& prior, const MotionPosterior& posterior) {
  double out = 0.0;
  for (std::size_t h = 0; h < prior.hypotheses.size(); ++h) {
    if (prior.hypotheses[h].has_drift) out += posterior.probabilities[h];
  }
  return out;
}

void count_probabilities(const MotionPrior& prior,
                         const MotionPosterior& posterior,
                         Report& report) {
  if (prior.hypotheses.size() < 2) return;
  double probabilities[] = {0.0, 0.0, 0.0};
  for (std::size_t h = 0; h < prior.hypotheses.size(); ++h) {
    probabilities[static_cast<std::size_t>(prior.hypotheses[h].covariance)] +=
        posterior.probabilities[h];
  }
  report.count("probability.as_stated", probabilities[0]);
  report.count("probability.scaled", probabilities[1]);
  report.count("probability.free", probabilities[2]);
  report.count("probability.drift", drift_probability(prior, posterior));
}

/// Subsamples the models: each iteration of the average factorises one dense matrix per model, and
/// with many closures the models differ less.
std::vector<MotionModel> thinned(const std::vector<MotionModel>& draws, std::size_t closures) {
  constexpr std::size_t kFewClosures = 16;
  constexpr std::size_t kAveraged = 64;
  if (closures <= kFewClosures || draws.size() <= kAveraged) return draws;
  std::vector<MotionModel> out;
  for (const std::size_t i : evenly_spaced(draws.size(), kAveraged)) out.push_back(draws[i]);
  return out;
}

struct LargestMove {
  double moved = 0.0;      ///< largest displacement of any keyframe [m]
  double explained = 0.0;  ///< largest displacement explained by the gap of one closure [m]
};

/// Compares the largest displacement of a correction with the displacement that the loop gaps
/// explain. A gap of t [m] and r [rad] explains t + r R, where R is the
/// distance from the loop's last keyframe to the keyframe farthest from it. `gap` holds six numbers
/// per closure. O(keyframes closures).
LargestMove largest_move(const Problem& problem,
                         const Eigen::VectorXd& gap,
                         const Trajectory& corrected) {
  const auto distance = [](const StampedPose& a, const StampedPose& b) {
    return (a.world_from_body.translation - b.world_from_body.translation).norm();
  };
  LargestMove out;
  for (std::size_t i = 0; i < corrected.size(); ++i) {
    out.moved = std::max(out.moved, distance(corrected[i], problem.keyframes[i]));
  }
  for (std::size_t k = 0; k < problem.closures.size(); ++k) {
    double farthest = 0.0;
    for (const StampedPose& keyframe : problem.keyframes) {
      farthest = std::max(farthest, distance(keyframe, problem.keyframes[problem.closures[k].to]));
    }
    const auto twist = of_closure(gap, k);
    out.explained =
        std::max(out.explained, twist.head<3>().norm() + farthest * twist.tail<3>().norm());
  }
  return out;
}

/// Loops that cover a small part of the chain leave the rest to extrapolation.
void note_large_move(const LargestMove& move, Report& report) {
  constexpr double kLarge = 3.0;
  report.count("largest_move", move.moved);
  report.count("explained_move", move.explained);
  if (!(move.moved > kLarge * move.explained + 1e-6)) return;
  const auto rounded = [](double metres) -> std::string {
    if (metres < 0.005) return "0.00";
    const double unit = std::pow(10.0, std::floor(std::log10(metres)) - 1.0);
    std::string text = std::to_string(std::round(metres / unit) * unit);
    return text.substr(0, text.find('.') + (metres < 10.0 ? 3 : 0));
  };
  report.notes.push_back("largest keyframe displacement is " + rounded(move.moved) +
                         " m, the loop gaps explain " + rounded(move.explained) +
                         " m: the drift is extrapolated far beyond the loops");
}

void count_rates(const DriftRates& rates, Report& report) {
  constexpr const char* kNames[] = {"per_metre.x", "per_metre.y", "per_metre.z", "per_radian"};
  for (Eigen::Index k = 0; k < rates.size(); ++k) {
    if (rates[k] != 0.0) report.count(std::string("shared.") + kNames[k], rates[k]);
  }
}

double squared_change(const std::vector<Twist>& errors, const std::vector<Twist>& other) {
  double sum = 0.0;
  for (std::size_t i = 0; i < errors.size(); ++i) sum += (errors[i] - other[i]).squaredNorm();
  return sum;
}

}  // namespace

std::string MotionDrift::why_declined(const Problem& problem) const {
  return loops_fault(problem, options_.max_closures);
}

Trajectory MotionDrift::correct(const Problem& problem, Report& report) const {
  if (options_.scale && has_scale_drift(problem)) {
    return correct_rigid(remove_scale_drift(problem), report, false);
  }
  if (!options_.related || !problem.related) return correct_rigid(problem, report, false);
  const DriftRates shared =
      report.time("related chains", [&] { return repeated_drift(problem, report); });
  count_rates(shared, report);
  if (shared.isZero(0.0)) return correct_rigid(problem, report, false);
  return correct_rigid(without_drift(problem, shared), report, true);
}

bool MotionDrift::abstains(const MotionPrior& prior,
                           const MotionPosterior& posterior,
                           std::size_t closures) const {
  if (closures >= static_cast<std::size_t>(options_.abstain_closures)) return false;
  if (std::ranges::any_of(prior.hypotheses.front().medians, &Term::given)) return false;
  const double before = options_.prior.drift_probability;
  const double after = drift_probability(prior, posterior);
  return after * (1.0 - before) < options_.abstain_factor * (1.0 - after) * before || after == 0.0;
}

Trajectory MotionDrift::correct_rigid(const Problem& problem, Report& report, bool rescale) const {
  std::vector<EdgeMotion> edge_motions = motions(problem);
  limit_drift(edge_motions, problem, options_.prior.drift_reach);
  LoopedChain chain(problem, stated_noise_model(problem));
  const Eigen::VectorXd gap = chain.linearise().gap;
  const MotionPrior prior =
      prior_of(model_of(options_, problem.planar), options_.prior, problem, edge_motions, gap);
  MotionPosterior posterior;
  posterior.centre = prior.hypotheses.back().medians;
  chain.set_noise_model(noise_model_of(posterior.centre, problem, edge_motions));
  int iterations = chain.minimise(options_.max_iterations, options_.tolerance);
  if (options_.fit) {
    const auto fitted =
        evenly_spaced(problem.closures.size(), static_cast<std::size_t>(options_.fit_closures));
    posterior = posterior_of(prior,
                             evidence_of(posterior.centre, chain, problem, edge_motions, fitted),
                             options_.sampling);
    report.count("log_evidence", posterior.log_evidence);
    count_probabilities(prior, posterior, report);
    if (abstains(prior, posterior, problem.closures.size())) {
      report.count("abstained", 1.0);
      return Dual({.scale = false, .rescale = rescale}).correct(problem, report);
    }
    chain.set_noise_model(noise_model_of(posterior.centre, problem, edge_motions));
    iterations += chain.minimise(options_.max_iterations, options_.tolerance);
  }
  const bool is_averaged =
      problem.closures.size() <= static_cast<std::size_t>(options_.average_closures);
  if (posterior.draws.size() > 1 && is_averaged) {
    iterations +=
        average(thinned(posterior.draws, problem.closures.size()), chain, problem, edge_motions);
  }
  report.count("iterations", iterations);
  for (const Term& term : posterior.centre) {
    const bool is_drift = term.kind == TermKind::drift;  // whose option is a standard deviation
    report.count(name_of(term), is_drift ? std::sqrt(term.value) : term.value);
  }
  Trajectory out = chain.keyframes();
  note_large_move(largest_move(problem, gap, out), report);
  return out;
}

int MotionDrift::average(const std::vector<MotionModel>& models,
                         LoopedChain& chain,
                         const Problem& problem,
                         const std::vector<EdgeMotion>& edge_motions) const {
  const std::vector<Twist> zero(edge_motions.size(), Twist::Zero());
  double last = std::numeric_limits<double>::infinity();
  for (int iterations = 0; iterations < options_.max_iterations; ++iterations) {
    std::vector<Twist> errors = mean_errors(models, chain, problem, edge_motions);
    const double change = squared_change(errors, chain.errors());
    if (!(change < last)) return iterations;  // converged to rounding, or diverging
    last = change;
    chain.set_errors(std::move(errors));
    if (change <= options_.tolerance * squared_change(chain.errors(), zero)) return iterations + 1;
  }
  return options_.max_iterations;
}

}  // namespace loopbench::methods

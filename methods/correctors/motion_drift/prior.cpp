#include <algorithm>
#include <cmath>
#include <numbers>

#include "methods/correctors/motion_drift/loop_averages.hpp"
#include "methods/correctors/motion_drift/posterior.hpp"

namespace loopbench::methods {
namespace {

/// The stated closure covariance is kept if stated variance / squared gap is at most this (a factor
/// of 5 in deviation). [-]
constexpr double kPlausibleRatio = 25.0;

/// Minimum fraction of a stated variance that is used. It sets a scale when all gaps are zero.
constexpr double kMinFraction = 1e-12;

/// Stated closure variance, bounded by the gaps: deviations stated in other units can exceed the
/// gaps by orders of magnitude, which would inflate the odometry variances as well.
double plausible(const LoopAverages& loops, Component component) {
  const double stated = loops.stated(component);
  return std::min(stated, std::max(kPlausibleRatio * loops.gap(component), kMinFraction * stated));
}

bool is_guessed(const Term& term, TermKind kind) { return term.kind == kind && !term.given; }

void guess_odometry(MotionModel& model, const MotionPriorOptions& by, const LoopAverages& loops) {
  const double squared_path = loops.motion(Component::translation, Regressor::distance, true);
  const bool drifts =
      std::ranges::any_of(model, [](const Term& t) { return is_guessed(t, TermKind::drift); });
  const bool states =
      std::ranges::any_of(model, [](const Term& t) { return t.kind == TermKind::stated; });
  // A position gap is also evidence of a rotation error, so a small rotation gap alone does not
  // imply a small rotation noise.
  const double variance_r =
      plausible(loops, Component::rotation) + loops.gap(Component::rotation) +
      (squared_path > 0.0 ? loops.gap(Component::translation) / squared_path : 0.0);
  const double drift_over_noise =
      drifts ? loops.motion(Component::rotation, Regressor::time, false) / by.drift_after : 0.0;
  const double noise_r = variance_r / (1.0 + drift_over_noise);
  const double noise_t =
      by.noise_ratio * by.noise_ratio * squared_path + plausible(loops, Component::translation);

  for (Term& term : model) {
    if (term.given || term.kind == TermKind::closures) continue;
    double square = term.component == Component::translation ? noise_t : noise_r;
    double unit = 0.0;
    if (term.kind == TermKind::stated) {
      square = noise_r * by.stated_fraction;
      unit = loops.stated_odometry(Component::rotation);
    } else {
      const bool noise = term.kind == TermKind::noise;
      square *= !noise ? drift_over_noise : states ? 1.0 - by.stated_fraction : 1.0;
      unit = loops.motion(term.component, term.regressor, !noise);
      unit *= static_cast<double>(std::ranges::count_if(model, [&](const Term& other) {
        return is_guessed(other, term.kind) && other.component == term.component &&
               other.axis == term.axis;
      }));
    }
    term.value = unit > 0.0 ? square / unit : 0.0;
  }
}

void guess_closures(MotionModel& model, const LoopAverages& loops) {
  double noise[2] = {0.0, 0.0};  // modelled noise variance accumulated along a loop
  for (const Term& term : model) {
    if (term.kind != TermKind::noise) continue;
    noise[static_cast<int>(term.component)] +=
        term.value * loops.motion(term.component, term.regressor, false);
  }
  for (Term& term : model) {
    if (!is_guessed(term, TermKind::closures)) continue;
    term.value = 1.0;
    const double stated = loops.stated(term.component), gap = loops.gap(term.component);
    if (stated <= kPlausibleRatio * gap) continue;
    const double by_odometry =
        noise[static_cast<int>(term.component)] / loops.stated_odometry(term.component);
    term.value = std::min(1.0, std::max(by_odometry, 0.01 * gap / stated));
  }
}

/// Indices of the unknowns that all hypotheses share; those of individual terms follow.
enum : Eigen::Index {
  kChoice,
  kTranslation,
  kRotation,
  kDrift,
  kAxis,
  kRegressor = kAxis + 3,
  kOwn = kRegressor + static_cast<Eigen::Index>(kRegressors.size())
};

std::vector<std::vector<MotionPrior::Loading>> loadings_of(const MotionModel& medians,
                                                           const MotionPriorOptions& options,
                                                           bool planar) {
  std::vector<std::vector<MotionPrior::Loading>> out;
  Eigen::Index own = kOwn;
  for (const Term& term : medians) {
    std::vector<MotionPrior::Loading> loadings;
    if (term.kind != TermKind::closures) {
      const bool is_translation =
          term.kind != TermKind::stated && term.component == Component::translation;
      loadings.push_back({is_translation ? kTranslation : kRotation, options.common_dispersion});
    }
    if (term.kind == TermKind::drift) {
      loadings.push_back({kDrift, options.drift_dispersion});
      if (term.axis >= 0) {
        // A planar problem has only one rotation axis.
        if (!planar) loadings.push_back({kAxis + term.axis, options.axis_dispersion});
        loadings.push_back(
            {kRegressor + static_cast<Eigen::Index>(term.regressor), options.term_dispersion});
      }
    }
    if (term.axis < 0) {
      loadings.push_back({own++,
                          term.kind == TermKind::stated     ? options.stated_dispersion
                          : term.kind == TermKind::closures ? options.closures_dispersion
                                                            : options.term_dispersion});
    }
    out.push_back(std::move(loadings));
  }
  return out;
}

bool has_guessed(const MotionModel& model, TermKind kind) {
  return std::ranges::any_of(model, [&](const Term& term) { return is_guessed(term, kind); });
}

/// Converts the free hypothesis into one of the simple ones.
void simplify(MotionPrior::Hypothesis& to, Covariance covariance, const MotionPriorOptions& by) {
  to.covariance = covariance;
  double stated = 0.0;
  for (Term& term : to.medians) {
    if (term.kind == TermKind::stated)
      stated = term.value /= by.stated_fraction;  // the whole noise
    if (is_guessed(term, TermKind::noise)) term.value = 0.0;
  }
  for (std::size_t j = 0; j < to.medians.size(); ++j) {
    Term& term = to.medians[j];
    const bool follows =
        covariance == Covariance::as_stated && is_guessed(term, TermKind::closures);
    if (follows) term.value = stated;
    if (follows || term.kind == TermKind::stated)
      to.loadings[j] = {{kRotation, by.common_dispersion}};
  }
}

}  // namespace

MotionPrior prior_of(const MotionModel& model,
                     const MotionPriorOptions& options,
                     const Problem& problem,
                     const std::vector<EdgeMotion>& motions,
                     const Eigen::VectorXd& gap) {
  MotionModel medians = model;
  const LoopAverages loops(problem, motions, gap);
  guess_odometry(medians, options, loops);
  guess_closures(medians, loops);
  std::erase_if(medians, [](const Term& term) { return term.value == 0.0; });

  MotionPrior out;
  out.unknowns = kOwn + static_cast<Eigen::Index>(medians.size());
  const MotionPrior::Hypothesis all{
      Covariance::free, true, 1.0, medians, loadings_of(medians, options, problem.planar)};
  const bool drifts = has_guessed(medians, TermKind::drift);
  const double probabilities[] = {
      options.as_stated_probability,
      options.scaled_probability,
      std::max(0.0, 1.0 - options.as_stated_probability - options.scaled_probability)};
  for (const bool with_drift : {false, true}) {
    if (!with_drift && !drifts) continue;
    for (const Covariance covariance :
         {Covariance::as_stated, Covariance::scaled, Covariance::free}) {
      MotionPrior::Hypothesis one = all;
      if (covariance != Covariance::free) {
        if (!has_guessed(medians, TermKind::stated)) continue;
        simplify(one, covariance, options);
      }
      one.probability = probabilities[static_cast<std::size_t>(covariance)];
      if (drifts)
        one.probability *= with_drift ? options.drift_probability : 1.0 - options.drift_probability;
      one.has_drift = with_drift;
      for (Term& term : one.medians) {
        if (is_guessed(term, TermKind::drift) && !with_drift) term.value = 0.0;
      }
      out.hypotheses.push_back(std::move(one));
    }
  }
  return out;
}

std::size_t hypothesis_at(const MotionPrior& prior, const Eigen::VectorXd& unknowns) {
  double sum = 0.0;
  for (const MotionPrior::Hypothesis& h : prior.hypotheses) sum += h.probability;
  double left = 0.5 * std::erfc(-unknowns[kChoice] / std::numbers::sqrt2) * sum;
  std::size_t out = 0;
  while (out + 1 < prior.hypotheses.size() && left >= prior.hypotheses[out].probability) {
    left -= prior.hypotheses[out++].probability;
  }
  return out;
}

MotionModel model_at(const MotionPrior& prior, const Eigen::VectorXd& unknowns) {
  const MotionPrior::Hypothesis& chosen = prior.hypotheses[hypothesis_at(prior, unknowns)];
  MotionModel out = chosen.medians;
  for (std::size_t j = 0; j < out.size(); ++j) {
    double log_factor = 0.0;
    for (const MotionPrior::Loading& loading : chosen.loadings[j]) {
      log_factor += loading.coefficient * unknowns[loading.unknown];
    }
    out[j].value *= std::exp(log_factor);
  }
  return out;
}

}  // namespace loopbench::methods

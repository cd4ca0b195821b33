#include "methods/correctors/motion_drift/prior.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace loopbench {
namespace {

/// Gaps are rarely five times smaller than what the closures alone are said to err by. [-]
constexpr double kHonest = 25.0;

/// Means over the closures of squares of an axis, by half: [m^2], [rad^2].
struct ClosureMeans {
  double gap[2] = {0.0, 0.0};
  double stated[2] = {0.0, 0.0};  ///< variance
};

ClosureMeans means_of(const Problem& problem, const Eigen::VectorXd& gap) {
  ClosureMeans out;
  const auto count = static_cast<double>(problem.closures.size());
  // A planar gap is x, y, yaw: nothing is lost by summing the zeros beside them.
  const double axes[2] = {problem.planar ? 2.0 : 3.0, problem.planar ? 1.0 : 3.0};
  for (std::size_t k = 0; k < problem.closures.size(); ++k) {
    const Matrix6 covariance = problem.closures[k].information.inverse();
    for (int half = 0; half < 2; ++half) {
      const auto at = static_cast<Eigen::Index>(6 * k) + 3 * half;
      out.gap[half] += gap.segment<3>(at).squaredNorm() / (axes[half] * count);
      out.stated[half] += covariance.diagonal().segment<3>(3 * half).mean() / count;
    }
  }
  return out;
}

/// Mean over the closures of what `of` gathers along their way, squared if wanted.
template <class Of>
double gathered(const Problem& problem, bool squared, Of of) {
  const std::size_t edges = problem.odometry.size();
  std::vector<double> sum(edges + 1, 0.0);
  for (std::size_t i = 0; i < edges; ++i) sum[i + 1] = sum[i] + of(i);
  double mean = 0.0;
  for (const Edge& loop : problem.closures) {
    const double along = sum[loop.to] - sum[loop.from];
    mean += (squared ? along * along : along) / static_cast<double>(problem.closures.size());
  }
  return mean;
}

double stated_variance(const Problem& problem, Half half, std::size_t edge) {
  const Eigen::Index at = half == Half::translation ? 0 : 3;
  return problem.odometry[edge].information.inverse().diagonal().segment<3>(at).mean();
}

bool is_guessed(const Term& term, Cause cause) { return term.cause == cause && !term.given; }

void guess_odometry(MotionModel& model,
                    const MotionPriorOptions& by,
                    const Problem& problem,
                    const std::vector<EdgeMotion>& motions,
                    const ClosureMeans& closures) {
  const auto over_loops = [&](Growth growth, bool squared) {
    return gathered(problem, squared, [&](std::size_t i) { return grown(growth, motions[i]); });
  };
  const double way = over_loops(Growth::distance, true);
  const bool drifts =
      std::ranges::any_of(model, [](const Term& t) { return is_guessed(t, Cause::drift); });
  const bool states =
      std::ranges::any_of(model, [](const Term& t) { return t.cause == Cause::stated; });
  // A gap in position comes from turning, too: a loop that happens to close in attitude is no
  // proof.
  const double turn =
      closures.stated[1] + closures.gap[1] + (way > 0.0 ? closures.gap[0] / way : 0.0);
  const double steady = drifts ? over_loops(Growth::time, false) / by.steady_after : 0.0;
  const double noise_r = turn / (1.0 + steady);
  const double noise_t = by.noise_part * by.noise_part * way + closures.stated[0];

  for (Term& term : model) {
    if (term.given || term.cause == Cause::closures) continue;
    double square = term.half == Half::translation ? noise_t : noise_r;
    double unit = 0.0;
    if (term.cause == Cause::stated) {
      square = noise_r * by.stated_part;
      unit = gathered(problem, false, [&](std::size_t i) {
        return stated_variance(problem, Half::rotation, i);
      });
    } else {
      const bool noise = term.cause == Cause::noise;
      square *= !noise ? steady : states ? 1.0 - by.stated_part : 1.0;
      unit = over_loops(term.growth, !noise);
      unit *= static_cast<double>(std::ranges::count_if(model, [&](const Term& other) {
        return is_guessed(other, term.cause) && other.half == term.half && other.axis == term.axis;
      }));
    }
    term.value = unit > 0.0 ? square / unit : 0.0;
  }
}

void guess_closures(MotionModel& model,
                    const Problem& problem,
                    const std::vector<EdgeMotion>& motions,
                    const ClosureMeans& closures) {
  double noise[2] = {0.0, 0.0};  // what the model has a loop gather
  for (const Term& term : model) {
    if (term.cause != Cause::noise) continue;
    noise[static_cast<int>(term.half)] += gathered(
        problem, false, [&](std::size_t i) { return term.value * grown(term.growth, motions[i]); });
  }
  for (Term& term : model) {
    if (!is_guessed(term, Cause::closures)) continue;
    const int half = static_cast<int>(term.half);
    term.value = 1.0;
    if (closures.stated[half] <= kHonest * closures.gap[half]) continue;
    const double stated = gathered(
        problem, false, [&](std::size_t i) { return stated_variance(problem, term.half, i); });
    const double at_least =
        std::max(noise[half] / stated, 0.01 * closures.gap[half] / closures.stated[half]);
    term.value = std::min(1.0, at_least);
  }
}

/// What every hypothesis knows u by; a term's own follow.
enum : Eigen::Index {
  kChoice,
  kTranslation,
  kRotation,
  kSteady,
  kAxis,
  kGrowth = kAxis + 3,
  kOwn = kGrowth + static_cast<Eigen::Index>(kGrowths.size())
};

std::vector<std::vector<MotionPrior::Hang>> hangs_of(const MotionModel& medians,
                                                     const MotionPriorOptions& options,
                                                     bool planar) {
  std::vector<std::vector<MotionPrior::Hang>> out;
  Eigen::Index own = kOwn;
  for (const Term& term : medians) {
    std::vector<MotionPrior::Hang> hangs;
    if (term.cause != Cause::closures) {
      const bool moves = term.cause != Cause::stated && term.half == Half::translation;
      hangs.push_back({moves ? kTranslation : kRotation, options.scale_spread});
    }
    if (term.cause == Cause::drift) {
      hangs.push_back({kSteady, options.steady_spread});
      if (term.axis >= 0) {
        // In the plane there is one axis to turn about and nothing to compare it with.
        if (!planar) hangs.push_back({kAxis + term.axis, options.axis_spread});
        hangs.push_back({kGrowth + static_cast<Eigen::Index>(term.growth), options.share_spread});
      }
    }
    if (term.axis < 0) {
      hangs.push_back({own++,
                       term.cause == Cause::stated     ? options.stated_spread
                       : term.cause == Cause::closures ? options.closures_spread
                                                       : options.share_spread});
    }
    out.push_back(std::move(hangs));
  }
  return out;
}

bool guesses(const MotionModel& model, Cause cause) {
  return std::ranges::any_of(model, [&](const Term& term) { return is_guessed(term, cause); });
}

/// Turns the free hypothesis into one of the simple ones.
void simplify(MotionPrior::Hypothesis& to, Covariance covariance, const MotionPriorOptions& by) {
  to.covariance = covariance;
  double stated = 0.0;
  for (Term& term : to.medians) {
    if (term.cause == Cause::stated) stated = term.value /= by.stated_part;  // all of the noise
    if (is_guessed(term, Cause::noise)) term.value = 0.0;
  }
  for (std::size_t j = 0; j < to.medians.size(); ++j) {
    Term& term = to.medians[j];
    const bool follows = covariance == Covariance::as_stated && is_guessed(term, Cause::closures);
    if (follows) term.value = stated;
    if (follows || term.cause == Cause::stated) to.hangs[j] = {{kRotation, by.scale_spread}};
  }
}

}  // namespace

MotionPrior prior_of(const MotionModel& model,
                     const MotionPriorOptions& options,
                     const Problem& problem,
                     const std::vector<EdgeMotion>& motions,
                     const Eigen::VectorXd& gap) {
  MotionModel medians = model;
  const ClosureMeans closures = means_of(problem, gap);
  guess_odometry(medians, options, problem, motions, closures);
  guess_closures(medians, problem, motions, closures);
  std::erase_if(medians, [](const Term& term) { return term.value == 0.0; });

  MotionPrior out;
  out.unknowns = kOwn + static_cast<Eigen::Index>(medians.size());
  const MotionPrior::Hypothesis all{
      Covariance::free, true, 1.0, medians, hangs_of(medians, options, problem.planar)};
  const bool drifts = guesses(medians, Cause::drift);
  const double chances[] = {options.as_stated_chance,
                            options.scaled_chance,
                            std::max(0.0, 1.0 - options.as_stated_chance - options.scaled_chance)};
  for (const bool steady : {false, true}) {
    if (!steady && !drifts) continue;
    for (const Covariance covariance :
         {Covariance::as_stated, Covariance::scaled, Covariance::free}) {
      MotionPrior::Hypothesis one = all;
      if (covariance != Covariance::free) {
        if (!guesses(medians, Cause::stated)) continue;
        simplify(one, covariance, options);
      }
      one.chance = chances[static_cast<std::size_t>(covariance)];
      if (drifts) one.chance *= steady ? options.steady_chance : 1.0 - options.steady_chance;
      one.steady = steady;
      for (Term& term : one.medians) {
        if (is_guessed(term, Cause::drift) && !steady) term.value = 0.0;
      }
      out.hypotheses.push_back(std::move(one));
    }
  }
  return out;
}

std::size_t hypothesis_at(const MotionPrior& prior, const Eigen::VectorXd& unknowns) {
  double sum = 0.0;
  for (const MotionPrior::Hypothesis& h : prior.hypotheses) sum += h.chance;
  double left = 0.5 * std::erfc(-unknowns[kChoice] / std::numbers::sqrt2) * sum;
  std::size_t out = 0;
  while (out + 1 < prior.hypotheses.size() && left >= prior.hypotheses[out].chance) {
    left -= prior.hypotheses[out++].chance;
  }
  return out;
}

MotionModel model_at(const MotionPrior& prior, const Eigen::VectorXd& unknowns) {
  const MotionPrior::Hypothesis& chosen = prior.hypotheses[hypothesis_at(prior, unknowns)];
  MotionModel out = chosen.medians;
  for (std::size_t j = 0; j < out.size(); ++j) {
    double log_factor = 0.0;
    for (const MotionPrior::Hang& hang : chosen.hangs[j]) {
      log_factor += hang.spread * unknowns[hang.unknown];
    }
    out[j].value *= std::exp(log_factor);
  }
  return out;
}

}  // namespace loopbench

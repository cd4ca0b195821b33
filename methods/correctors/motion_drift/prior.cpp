#include "methods/correctors/motion_drift/prior.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

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

}  // namespace

MotionPrior prior_of(const MotionModel& model,
                     const MotionPriorOptions& options,
                     const Problem& problem,
                     const std::vector<EdgeMotion>& motions,
                     const Eigen::VectorXd& gap) {
  MotionPrior out{model, {}, 0};
  const ClosureMeans closures = means_of(problem, gap);
  guess_odometry(out.medians, options, problem, motions, closures);
  guess_closures(out.medians, problem, motions, closures);
  std::erase_if(out.medians, [](const Term& term) { return term.value == 0.0; });

  enum : Eigen::Index { kTranslation, kRotation, kSteady, kAxis, kGrowth = kAxis + 3 };
  out.unknowns = kGrowth + static_cast<Eigen::Index>(kGrowths.size());
  for (const Term& term : out.medians) {
    std::vector<MotionPrior::Hang> hangs;
    if (term.cause != Cause::closures) {
      const bool moves = term.cause != Cause::stated && term.half == Half::translation;
      hangs.push_back({moves ? kTranslation : kRotation, options.scale_spread});
    }
    if (term.cause == Cause::drift) {
      hangs.push_back({kSteady, options.steady_spread});
      if (term.axis >= 0) {
        // In the plane there is one axis to turn about and nothing to compare it with.
        if (!problem.planar) hangs.push_back({kAxis + term.axis, options.axis_spread});
        hangs.push_back({kGrowth + static_cast<Eigen::Index>(term.growth), options.share_spread});
      }
    }
    if (term.axis < 0) {
      hangs.push_back({out.unknowns++,
                       term.cause == Cause::stated     ? options.stated_spread
                       : term.cause == Cause::closures ? options.closures_spread
                                                       : options.share_spread});
    }
    out.hangs.push_back(std::move(hangs));
  }
  return out;
}

MotionModel model_at(const MotionPrior& prior, const Eigen::VectorXd& unknowns) {
  MotionModel out = prior.medians;
  for (std::size_t j = 0; j < out.size(); ++j) {
    double log_factor = 0.0;
    for (const MotionPrior::Hang& hang : prior.hangs[j]) {
      log_factor += hang.spread * unknowns[hang.unknown];
    }
    out[j].value *= std::exp(log_factor);
  }
  return out;
}

}  // namespace loopbench

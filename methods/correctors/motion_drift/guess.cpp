#include "methods/correctors/motion_drift/guess.hpp"

#include <algorithm>

namespace loopbench {
namespace {

/// Means over the closures of squares of an axis, by half: [m^2], [rad^2].
struct ClosureMeans {
  double gap[2] = {0.0, 0.0};
  double stated[2] = {0.0, 0.0};  ///< variance
};

ClosureMeans means(const Problem& problem, const Eigen::VectorXd& gap) {
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
double gathered(const Problem& problem, std::size_t edges, bool squared, Of of) {
  std::vector<double> sum(edges + 1, 0.0);
  for (std::size_t i = 0; i < edges; ++i) sum[i + 1] = sum[i] + of(i);
  double mean = 0.0;
  for (const Edge& loop : problem.closures) {
    const double along = sum[loop.to] - sum[loop.from];
    mean += (squared ? along * along : along) / static_cast<double>(problem.closures.size());
  }
  return mean;
}

}  // namespace

void guess(MotionModel& model,
           const Guess& by,
           const Problem& problem,
           const std::vector<EdgeMotion>& motions,
           const Eigen::VectorXd& gap) {
  const std::size_t edges = motions.size();
  const ClosureMeans closures = means(problem, gap);
  const double way =
      gathered(problem, edges, true, [&](std::size_t i) { return motions[i].metres; });
  // A gap in position comes from turning, too: a loop that happens to close in attitude is no
  // proof.
  const double turn =
      closures.stated[1] + closures.gap[1] + (way > 0.0 ? closures.gap[0] / way : 0.0);
  const bool drifts =
      std::ranges::any_of(model, [](const Term& t) { return t.cause == Cause::drift; });
  for (Term& term : model) {
    if (term.given || term.cause == Cause::closures) continue;
    const bool noise = term.cause == Cause::noise;
    const auto alike = static_cast<double>(std::ranges::count_if(model, [&](const Term& other) {
      return other.cause == term.cause && other.half == term.half && !other.given;
    }));
    const double unit = gathered(
        problem, edges, !noise, [&](std::size_t i) { return grown(term.growth, motions[i]); });
    const double part = noise ? by.noise_part : by.drift_part;
    const double share = !drifts ? 1.0 : noise ? by.rotation_noise : 1.0 - by.rotation_noise;
    const double square = term.half == Half::translation
                              ? part * part * way + (noise ? closures.stated[0] : 0.0)
                              : share * turn;
    term.value = unit > 0.0 ? square / (alike * unit) : 0.0;
  }

  double noise[2] = {0.0, 0.0};  // what the model has a loop gather
  for (const Term& term : model) {
    if (term.cause != Cause::noise) continue;
    noise[static_cast<int>(term.half)] += gathered(problem, edges, false, [&](std::size_t i) {
      return term.value * grown(term.growth, motions[i]);
    });
  }
  for (Term& term : model) {
    if (term.given || term.cause != Cause::closures) continue;
    const int half = static_cast<int>(term.half);
    const double stated = gathered(problem, edges, false, [&](std::size_t i) {
      return problem.odometry[i].information.inverse().diagonal().segment<3>(3 * half).mean();
    });
    const double at_least =
        std::max(noise[half] / stated, 0.01 * closures.gap[half] / closures.stated[half]);
    term.value = std::min(1.0, at_least);
  }
}

}  // namespace loopbench

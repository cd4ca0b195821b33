#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <utility>

#include "methods/correctors/chain.hpp"
#include "methods/correctors/chi_squared.hpp"
#include "methods/correctors/looped_chain.hpp"
#include "methods/solvers/initial_values.hpp"

namespace loopbench::methods {

std::optional<LoopedChain> chordal_chain(const Problem& problem, const NoiseModel& noise_model) {
  std::vector<ScaledPose> start;
  try {
    EliminationCache cache;
    start = chordal_values(problem, 1.0, cache);
  } catch (const std::runtime_error&) {
    return std::nullopt;
  }
  std::vector<Twist> errors;
  for (const Edge& edge : problem.odometry) {
    errors.push_back(edge_error(edge, start[edge.from].pose, start[edge.to].pose));
  }
  LoopedChain out(problem, noise_model);
  out.set_errors(std::move(errors));
  if (!std::isfinite(out.cost())) return std::nullopt;
  return out;
}

LoopedChain lowest_minimum(const Problem& problem,
                           const NoiseModel& noise_model,
                           const MinimumSettings& settings,
                           Report& report) {
  constexpr double kOtherMinimum = 1e-6;  // relative cost difference between two minima
  LoopedChain first(problem, noise_model);
  report.count("chi2_before", 2.0 * first.cost());
  if (!std::isfinite(first.cost())) throw std::runtime_error("dual: the cost is not finite");
  int iterations = first.minimise(settings.max_iterations, settings.tolerance);
  const bool may_be_lower = is_unlikely(2.0 * first.cost(), degrees_of_freedom(problem));
  std::optional<LoopedChain> second =
      settings.tries_chordal && may_be_lower ? chordal_chain(problem, noise_model) : std::nullopt;
  if (second) iterations += second->minimise(settings.max_iterations, settings.tolerance);
  const bool is_lower = second && second->cost() < first.cost() * (1.0 - kOtherMinimum);
  if (is_lower) {
    report.notes.push_back(fmt::format(
        "two minima: chi2 {:.6g} from the keyframes, {:.6g} from chordal relaxation; the lower "
        "one is returned",
        2.0 * first.cost(),
        2.0 * second->cost()));
  }
  report.count("iterations", iterations);
  LoopedChain out = is_lower ? std::move(*second) : std::move(first);
  report.count("chi2", 2.0 * out.cost());
  return out;
}

}  // namespace loopbench::methods

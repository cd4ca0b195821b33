#include "methods/correctors/dual.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <stdexcept>

#include "methods/correctors/chain.hpp"
#include "methods/correctors/looped_chain.hpp"
#include "methods/correctors/plausibility.hpp"
#include "methods/correctors/unit_of_length.hpp"
#include "methods/correctors/variance_components.hpp"
#include "methods/solvers/initial_values.hpp"

namespace loopbench::methods {
std::optional<std::string> Dual::declines(const Problem& problem) const {
  if (problem.closures.empty()) return "the problem has no loop closures";
  if (problem.closures.size() > static_cast<std::size_t>(options_.max_closures)) {
    return std::to_string(problem.closures.size()) +
           " closures exceed max_closures = " + std::to_string(options_.max_closures);
  }
  if (const std::string fault = chain_fault(problem); !fault.empty()) return fault;
  return std::nullopt;
}

Trajectory Dual::correct(const Problem& problem, Report& report) const {
  if (!options_.scale || !changes_unit(problem)) return correct_rigid(options_, problem, report);
  return correct_rigid(options_, in_one_unit(problem), report);
}

namespace {

/// Iterates until the cost converges; returns the number of iterations.
int minimise(LoopedChain& chain, const Dual::Options& options) {
  if (!std::isfinite(chain.cost())) throw std::runtime_error("dual: the cost is not finite");
  int iterations = 0;
  while (iterations < options.max_iterations) {
    const double before = chain.cost();
    if (!chain.step()) break;
    ++iterations;
    if (before - chain.cost() <= options.tolerance * before) break;
  }
  return iterations;
}

/// Sets `out` to the chain at its chordal relaxation, or leaves it empty when that is singular.
void start_chordal(const Problem& problem,
                   const ChainBelief& belief,
                   std::optional<LoopedChain>& out) {
  std::vector<ScaledPose> start;
  try {
    start = chordal_values(problem, 1.0);
  } catch (const std::runtime_error&) {
    return;  // singular to rounding
  }
  std::vector<Twist> errors;
  for (const Edge& edge : problem.odometry) {
    errors.push_back(edge_error(edge, start[edge.from].pose, start[edge.to].pose));
  }
  out.emplace(problem, belief).correct_by(std::move(errors));
  if (!std::isfinite(out->cost())) out.reset();
}

}  // namespace

Trajectory Dual::correct_rigid(const Options& options, const Problem& stated, Report& report) {
  std::optional<Problem> scaled;
  if (options.rescale) scaled = rescaled(stated, report);
  const Problem& problem = scaled ? *scaled : stated;
  const ChainBelief belief = stated_belief(problem);
  const std::size_t degrees = freedom(problem);
  LoopedChain first(problem, belief);
  report.count("cost_before", first.cost());
  int iterations = minimise(first, options);
  const LoopedChain* best = &first;
  std::optional<LoopedChain> second;
  if (options.start == Start::automatic && is_too_large(2.0 * first.cost(), degrees)) {
    start_chordal(problem, belief, second);
  }
  if (second) {
    constexpr double kOtherMinimum = 1e-6;  // relative cost difference between two minima
    iterations += minimise(*second, options);
    if (second->cost() < first.cost() * (1.0 - kOtherMinimum)) {
      best = &*second;
      report.notes.push_back(fmt::format(
          "two minima: chi2 {:.6g} from the keyframes, {:.6g} from chordal relaxation; the lower "
          "one is returned",
          2.0 * first.cost(),
          2.0 * second->cost()));
    }
  }
  report.count("iterations", iterations);
  report.count("cost", best->cost());
  report_chi2(2.0 * best->cost(), degrees, report);
  return best->keyframes();
}

}  // namespace loopbench::methods

#include "methods/correctors/dual.hpp"

#include <cmath>
#include <stdexcept>

#include "methods/correctors/chain.hpp"
#include "methods/correctors/looped_chain.hpp"
#include "methods/correctors/unit_of_length.hpp"

namespace loopbench {
std::optional<std::string> Dual::declines(const Problem& problem) const {
  if (problem.closures.empty()) return "no loop closure to spread";
  if (problem.closures.size() > static_cast<std::size_t>(options_.max_closures)) {
    return std::to_string(problem.closures.size()) +
           " closures, more than max_closures = " + std::to_string(options_.max_closures);
  }
  if (const std::string fault = chain_fault(problem); !fault.empty()) return fault;
  return std::nullopt;
}

Trajectory Dual::correct(const Problem& problem, Report& report) const {
  if (!options_.scale || !changes_unit(problem)) return correct_rigid(options_, problem, report);
  return correct_rigid(options_, in_one_unit(problem), report);
}

Trajectory Dual::correct_rigid(const Options& options, const Problem& problem, Report& report) {
  LoopedChain chain(problem, stated_belief(problem));
  report.count("cost_before", chain.cost());
  if (!std::isfinite(chain.cost())) throw std::runtime_error("dual: the cost is not finite");
  int iterations = 0;
  while (iterations < options.max_iterations) {
    const double before = chain.cost();
    if (!chain.step()) break;
    ++iterations;
    if (before - chain.cost() <= options.tolerance * before) break;
  }
  report.count("iterations", iterations);
  report.count("cost", chain.cost());
  return chain.keyframes();
}

}  // namespace loopbench

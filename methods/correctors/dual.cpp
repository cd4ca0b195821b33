#include "methods/correctors/dual.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <stdexcept>

#include "methods/correctors/chain.hpp"
#include "methods/correctors/looped_chain.hpp"
#include "methods/correctors/plausibility.hpp"
#include "methods/correctors/scale_drift.hpp"
#include "methods/correctors/variance_components.hpp"

namespace loopbench::methods {

std::string Dual::why_declined(const Problem& problem) const {
  return loops_fault(problem, options_.max_closures);
}

Trajectory Dual::correct(const Problem& problem, Report& report) const {
  if (!options_.scale || !has_scale_drift(problem)) return correct_rigid(options_, problem, report);
  return correct_rigid(options_, remove_scale_drift(problem), report);
}

Trajectory Dual::correct_rigid(const Options& options, const Problem& stated, Report& report) {
  std::optional<Problem> scaled;
  if (options.rescale) scaled = with_estimated_factors(stated, report);
  const Problem& problem = scaled ? *scaled : stated;
  const NoiseModel noise_model = stated_noise_model(problem);
  const std::size_t degrees = freedom(problem);
  LoopedChain first(problem, noise_model);
  report.count("chi2_before", 2.0 * first.cost());
  if (!std::isfinite(first.cost())) throw std::runtime_error("dual: the cost is not finite");
  int iterations = first.minimise(options.max_iterations, options.tolerance);
  const LoopedChain* best = &first;
  const bool is_implausible = is_too_large(2.0 * first.cost(), degrees);
  std::optional<LoopedChain> second = options.start == Start::automatic && is_implausible
                                          ? chordal_chain(problem, noise_model)
                                          : std::nullopt;
  if (second) {
    constexpr double kOtherMinimum = 1e-6;  // relative cost difference between two minima
    iterations += second->minimise(options.max_iterations, options.tolerance);
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
  report.count("chi2", 2.0 * best->cost());
  report_chi2(2.0 * best->cost(), degrees, report);
  return best->keyframes();
}

}  // namespace loopbench::methods

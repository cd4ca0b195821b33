/// What can be seen of a planted wrong step by one who knows more than any method.
#pragma once

#include <cstddef>
#include <optional>

#include "tests/studies/planted_problems.hpp"

namespace loopbench {

struct StepOracle {
  /// Log odds of the planted step being wrong over none, with the prior of StepSearch, from the
  /// true closures alone, linearised at the true poses: with the factors on the deviations that the
  /// same closures show without the wrong step, and with factors fitted under either explanation.
  double with_known_factors = 0.0, with_fitted_factors = 0.0;
  std::size_t best_step = 0;  ///< of the highest log odds among all, with the factors fitted to it
  double share = 0.0;         ///< of the planted step in the probability of all steps [-]
};

/// Requires a planted step.
StepOracle step_oracle(const TrueChain& chain, const PlantedProblem& of);

}  // namespace loopbench

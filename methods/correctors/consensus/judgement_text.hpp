/// Parts of sentences about a judgement of closures, for every command that prints one.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "methods/correctors/consensus/judgement.hpp"

namespace loopbench::methods {

/// Deviations of the odometry against those stated: "rotation: about 8 times the stated;
/// translation: larger". The rotation is a number only where the closures determine it.
std::string deviations_text(const EstimatedFactors& factors);

/// "larger", "smaller" or "as stated": a factor of 2 is the least that is called a difference.
std::string direction_text(double factor);

/// Indices of the closures that do not agree, those with the most evidence against them first.
std::vector<std::size_t> disagreeing_closures(const ClosureJudgement& judgement);

/// The closures with their keyframes and their distance from the prediction by those that agree:
/// "10 -> 40 (12.3 m, 5.1 deg)". At most five, then their number.
std::string closures_text(const Problem& problem,
                          const ClosureJudgement& judgement,
                          const std::vector<std::size_t>& closures);

/// The same in two groups: those that the others exclude, and those that slipped.
std::string disagreeing_text(const Problem& problem,
                             const ClosureJudgement& judgement,
                             const std::vector<std::size_t>& closures);

/// The steps of the odometry that are wrong: "59 -> 60 (3.2 m, 40 deg)"; empty without any.
std::string freed_steps_text(const Problem& problem, const ClosureJudgement& judgement);

/// Why nothing was decided, and what would be needed. Requires !judgement.is_decided().
std::string undecided_text(const ClosureJudgement& judgement);

}  // namespace loopbench::methods

/// Parts of a recording that all estimates cover.
#pragma once

#include <string>
#include <vector>

#include "harness/commands/eval/evaluated_sweep.hpp"

namespace loopbench::harness {

/// Sets EvaluatedRun::common, from the files: the times that all estimates of the run's sequence
/// cover, without their tracking gaps. Empty if every estimate is complete there (99 % of the time
/// of all). Estimates that cannot be read or cover less than half of the longest do not count.
void set_common_times(std::vector<EvaluatedRun>& runs, const EvalArguments& arguments);

/// The poses within the ranges of EvaluatedRun::common.
Trajectory poses_within(const Trajectory& poses, const std::string& common);

}  // namespace loopbench::harness

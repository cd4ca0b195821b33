/// The times that all estimates of a sequence cover.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "datasets/core/trajectory.hpp"
#include "harness/eval/arguments.hpp"
#include "harness/eval/recorded_runs.hpp"

namespace loopbench::harness {

using TimeRange = std::pair<double, double>;  ///< begin and end [s]

/// Sets RecordedRun::common, from the files: the times that all estimates of the run's sequence
/// cover, without their tracking gaps. Empty if every estimate is complete there (99 % of the time
/// of all). Estimates that cannot be read or cover less than half of the longest do not count.
void set_common_times(std::vector<RecordedRun>& runs, const EvalArguments& arguments);

/// The poses within the ranges of RecordedRun::common.
Trajectory poses_within(const Trajectory& poses, const std::string& common);

}  // namespace loopbench::harness

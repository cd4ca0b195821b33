/// What several estimates have in common: the times that all cover, and one alignment.
#pragma once

#include <string>
#include <vector>

#include "harness/eval/recorded_sweep.hpp"

namespace loopbench::harness {

/// Sets RecordedRun::common, from the files: the times that all estimates of the run's sequence
/// cover, without their tracking gaps. Empty if every estimate is complete there (99 % of the time
/// of all). Estimates that cannot be read or cover less than half of the longest do not count.
void set_common_times(std::vector<RecordedRun>& runs, const EvalArguments& arguments);

/// The poses within the ranges of RecordedRun::common.
Trajectory poses_within(const Trajectory& poses, const std::string& common);

/// For each run of the sweep, the alignment under each protocol, by least squares over the pairs of
/// all estimates of its group: all files if there is one reference, otherwise the runs of equal
/// name of one method. Files that cannot be read, or have no pairs, do not contribute. Throws
/// InputError for protocols without a least-squares alignment of all pairs, and if a group does not
/// determine it. O(n log n); files are read once more.
std::vector<std::vector<metrics::Alignment>> common_alignments(const RecordedSweep& files);

}  // namespace loopbench::harness

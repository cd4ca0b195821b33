/// Recordings behind references, and the times that all estimates of one cover.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "datasets/core/trajectory.hpp"
#include "harness/eval/arguments.hpp"
#include "harness/eval/recorded_runs.hpp"

namespace loopbench::harness {

/// Whether two references are one recording: after a rigid alignment, their positions at common
/// stamps (half of the shorter one's duration at least) differ by less than 1 % of their spread,
/// RMSE. Finds copies that are cropped, resampled, scaled by 0.1 % or have noise of some
/// millimetres, but none with other stamps. O(n).
bool is_same_recording(const Trajectory& one, const Trajectory& other);

/// Names recordings by the first of their references.
class Recordings {
 public:
  /// `content`: hash of the poses.
  std::string name_of(const std::string& content, const Trajectory& reference);

 private:
  std::vector<std::pair<std::string, Trajectory>> known_;
};

using TimeRange = std::pair<double, double>;  ///< begin and end [s]

/// Sets RecordedRun::common, from the files: the times that all estimates of the run's sequence
/// cover, without their tracking gaps. Empty if every estimate is complete there (99 % of the time
/// of all). Estimates that cannot be read or cover less than half of the longest do not count.
void set_common_times(std::vector<RecordedRun>& runs, const EvalArguments& arguments);

/// The poses within the ranges of RecordedRun::common.
Trajectory poses_within(const Trajectory& poses, const std::string& common);

}  // namespace loopbench::harness

/// Recordings behind references.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "datasets/core/trajectory.hpp"

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

}  // namespace loopbench::harness

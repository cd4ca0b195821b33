/// How a loop's closing error is divided among its steps.
#pragma once

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "datasets/core/problem.hpp"

namespace loopbench {

enum class StepWeights { index, time, distance, rotation };
inline auto choices(StepWeights) {
  return std::array{std::pair{"index", StepWeights::index},
                    std::pair{"time", StepWeights::time},
                    std::pair{"distance", StepWeights::distance},
                    std::pair{"rotation", StepWeights::rotation}};
}

/// What a loop may bend when it overlaps one that is closed already.
enum class LoopOverlap {
  whole,  ///< all its steps: earlier loops it overlaps come open again
  open,   ///< only steps that no earlier loop has closed: every loop stays closed
};
inline auto choices(LoopOverlap) {
  return std::array{std::pair{"whole", LoopOverlap::whole}, std::pair{"open", LoopOverlap::open}};
}

/// shares[i] >= 0 belongs to the step from keyframe i - 1 to i; shares[0] is not used. O(n).
std::vector<double> step_shares(const Trajectory& keyframes, StepWeights weights);

struct LoopShares {
  std::vector<double> cumulative;  ///< over steps from + 1 .. to; the last is exactly 1
  bool fell_back = false;          ///< all shares were zero: spread by index instead
};

/// Shares of the steps of a loop that are not frozen. Nothing when every step is frozen. O(loop).
std::optional<LoopShares> loop_shares(const std::vector<double>& shares,
                                      const std::vector<bool>& frozen,
                                      const Edge& loop);

/// Throws std::runtime_error, naming `method`, when closures are not sorted by (to, from) or name
/// no keyframe.
void check_closures(const Problem& problem, const char* method);

}  // namespace loopbench

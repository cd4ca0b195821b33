/// Distribution of a loop's closing error over its steps.
#pragma once

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "datasets/core/problem.hpp"
#include "methods/method.hpp"

namespace loopbench::methods {

enum class StepWeights { index, time, distance, rotation };
inline auto choices(StepWeights) {
  return std::array{std::pair{"index", StepWeights::index},
                    std::pair{"time", StepWeights::time},
                    std::pair{"distance", StepWeights::distance},
                    std::pair{"rotation", StepWeights::rotation}};
}

/// Steps that a loop may change when it overlaps an earlier loop.
enum class LoopOverlap {
  all,   ///< all its steps; earlier loops that it overlaps are no longer closed
  open,  ///< only steps that no earlier loop encloses; every loop stays closed
};
inline auto choices(LoopOverlap) {
  return std::array{std::pair{"all", LoopOverlap::all}, std::pair{"open", LoopOverlap::open}};
}

/// Returns the share of each step, >= 0. shares[i] belongs to the step from keyframe i - 1 to i;
/// shares[0] is unused. O(n).
std::vector<double> step_weights(const Trajectory& keyframes, StepWeights weights);

struct LoopShares {
  std::vector<double> cumulative;  ///< over the steps from + 1 .. to; the last value is exactly 1
  bool used_equal_shares = false;  ///< all shares were zero, so the steps have equal shares
};

/// Returns the shares of the steps of a loop that are not frozen, or nullopt when all are. O(loop).
std::optional<LoopShares> loop_shares(const std::vector<double>& shares,
                                      const std::vector<bool>& frozen,
                                      const Edge& loop);

/// A corrector that needs nothing but loop closures or anchors.
class LoopCorrector : public Corrector {
 public:
  std::string why_declined(const Problem& problem) const override;
};

/// Correction of a loop's closing error by rotation about its start and shift. The pivot is the
/// loop's start, so the result does not depend on the world frame.
struct LoopCorrection {
  Vector3 pivot;
  Vector3 phi;    ///< rotation vector from the end of the loop to its target [rad]
  Vector3 shift;  ///< remaining translation [m]

  LoopCorrection(const Pose& start, const Pose& end, const Edge& loop, bool with_rotation);

  /// Returns the pose moved by its share: Exp(share phi) (p - pivot) + pivot + share shift.
  Pose moved(double share, const Pose& pose) const;
};

/// Adds the counts `closures` and `largest_closing_error` [m] of the corrected poses.
void report_closing_errors(const Problem& problem, const Trajectory& corrected, Report& report);

/// Throws std::runtime_error with the name `method` when closures are not sorted by (to, from) or
/// refer to a missing keyframe.
void check_closures(const Problem& problem, const char* method);

}  // namespace loopbench::methods

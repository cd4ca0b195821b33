/// Distributes the closing error of each loop along the loop: the usual baseline.
#pragma once

#include "methods/correctors/shares.hpp"

namespace loopbench::methods {

/// For a closure a -> b with measured pose X_a L of b and cumulative share w_i (w_a = 0, w_b = 1):
///
///     dR = R_target R_b^T,  o = p_a,  dt = p_target - (dR (p_b - o) + o)
///     R_i' = Exp(w_i Log dR) R_i
///     p_i' = Exp(w_i Log dR) (p_i - o) + o + w_i dt
///
/// The poses after b move rigidly with b. The pivot is the loop's start, so the result does not
/// depend on the world frame. Information matrices are not used.
///
/// Several loops are closed one after the other in the order (to, from). The option `overlap`
/// selects the steps that a loop may change when it overlaps an earlier loop. Anchors are met last
/// (spread_to_anchors()), which opens loops that disagree with them.
///
/// Complexity O(keyframes + sum of loop lengths). Source: the rotation part as in Surmann,
/// Nuechter et al. (6D SLAM) and Sprickerhof et al. (ELCH), pivot moved to the loop's start.
class Uniform final : public LoopCorrector {
 public:
  enum class RotationMode { none, slerp };

  struct Options {
    RotationMode rotation = RotationMode::slerp;
    StepWeights weights = StepWeights::index;
    LoopOverlap overlap = LoopOverlap::all;
  };
  explicit Uniform(const Options& options) : options_(options) {}

  bool accepts_anchors() const override { return true; }

  /// Counts: `closures`, `largest_closing_error` [m] over all closures after the last one was
  /// closed. Throws std::runtime_error when closures are not sorted by (to, from) or refer to a
  /// missing keyframe.
  Trajectory correct(const Problem& problem, Report& report) const override;

 private:
  Options options_;
};

inline auto choices(Uniform::RotationMode) {
  return std::array{std::pair{"none", Uniform::RotationMode::none},
                    std::pair{"slerp", Uniform::RotationMode::slerp}};
}

template <class Visit>
void fields(Uniform::Options& o, Visit visit) {
  visit("rotation",
        o.rotation,
        "distribution of the rotation error; none: only positions change; slerp: along the "
        "shortest rotation");
  visit("weights", o.weights, "weights of the steps: equal, duration, distance or rotation angle");
  visit("overlap",
        o.overlap,
        "steps that a loop changes; all: all its steps, which reopens earlier loops it overlaps; "
        "open: only steps that no earlier loop encloses, so every loop stays closed");
}

}  // namespace loopbench::methods

/// Closes each loop in two passes: rotation (and scale) first, with re-integration of the chain,
/// then the remaining translation.
#pragma once

#include "methods/correctors/shares.hpp"

namespace loopbench::methods {

/// For a closure a -> b with measured L, cumulative shares w (rotation) and v (translation):
///
///     phi = Log(R_a L_R R_b^T),   R_i' = Exp(w_i phi) R_i
///     p_i' = p_{i-1}' + s^w_{i-1} Exp(w_{i-1} phi) (p_i - p_{i-1})        (re-integrated)
///     p_i'' = p_i' + v_i (p_a + R_a L_t - p_b')
///
/// where s is the closure's scale change when `scale` is on, divided by the scale that earlier
/// loops applied between a and b (scale drift of a monocular chain). The poses after b follow by
/// one similarity transform. Unlike in `uniform`, rotating a step moves only the poses after it, as
/// an odometry error does.
///
/// Anchors are met last, by shares v (distribute_anchor_errors()), which opens loops that disagree
/// with them.
///
/// Loops are closed one after the other in the order (to, from). O(keyframes + sum of loop
/// lengths). Source: trajectory bending of COP-SLAM (Dubbelman, Browning, ICRA 2012 and T-RO 2015),
/// implemented from the equations, with the shares as an option.
class TwoPass final : public LoopCorrector {
 public:
  struct Options {
    StepWeights rotation_weights = StepWeights::index;
    StepWeights translation_weights = StepWeights::index;
    LoopOverlap overlap = LoopOverlap::all;
    bool scale = true;
  };
  explicit TwoPass(const Options& options) : options_(options) {}

  bool accepts_anchors() const override { return true; }

  /// Counts: `closures`, `largest_closing_error` [m]. Throws std::runtime_error when closures are
  /// not sorted by (to, from) or refer to a missing keyframe.
  Trajectory correct(const Problem& problem, Report& report) const override;

 private:
  Options options_;
};

template <class Visit>
void fields(TwoPass::Options& o, Visit visit) {
  visit("rotation_weights",
        o.rotation_weights,
        "weights of the steps for the rotation error: equal, duration, distance or rotation angle");
  visit("translation_weights",
        o.translation_weights,
        "weights of the steps for the translation error: equal, duration, distance or rotation "
        "angle");
  visit("overlap",
        o.overlap,
        "steps that a loop changes: all its steps, or only those that no earlier loop encloses");
  visit("scale", o.scale, "also distribute the closures' scale change (Sim(3) chains)");
}

}  // namespace loopbench::methods

/// Two passes a loop: first rotation (and scale) is spread and the chain re-integrated, then what
/// is left of the translation.
#pragma once

#include "methods/correctors/shares.hpp"
#include "methods/method.hpp"

namespace loopbench {

/// For a closure a -> b with measured L, cumulative shares w (rotation) and v (translation):
///
///     phi = Log(R_a L_R R_b^T),   R_i' = Exp(w_i phi) R_i
///     p_i' = p_{i-1}' + s^w_{i-1} Exp(w_{i-1} phi) (p_i - p_{i-1})        (re-integrated)
///     p_i'' = p_i' + v_i (p_a + R_a L_t - p_b')
///
/// with s the closure's scale when `scale` is on: a monocular chain's unit creeps, and s is how
/// much, less what earlier loops have stretched between a and b. The poses after b follow by one
/// similarity. Unlike `uniform`, turning a step turns only what comes after it, as an odometer's
/// error does.
///
/// Loops are closed one after the other, by (to, from). Complexity O(keyframes + sum of loop
/// lengths). Source: the trajectory bending of COP-SLAM (Dubbelman, Browning, ICRA 2012 and T-RO
/// 2015), from its mathematics, with the shares an option.
class TwoPass final : public Corrector {
 public:
  struct Options {
    StepWeights rotation_weights = StepWeights::index;
    StepWeights translation_weights = StepWeights::index;
    LoopOverlap overlap = LoopOverlap::whole;
    bool scale = true;
  };
  explicit TwoPass(const Options& options) : options_(options) {}

  std::optional<std::string> declines(const Problem& problem) const override;

  /// Counts: `closures`, `largest_gap_left` [m]. Throws std::runtime_error when closures are not
  /// sorted by (to, from) or name no keyframe.
  Trajectory correct(const Problem& problem, Report& report) const override;

 private:
  Options options_;
};

template <class Visit>
void fields(TwoPass::Options& o, Visit visit) {
  visit(
      "rotation_weights", o.rotation_weights, "what a step's share of the turn is proportional to");
  visit("translation_weights",
        o.translation_weights,
        "what a step's share of the shift is proportional to");
  visit("overlap", o.overlap, "what a loop bends: all its steps, or those no earlier one closed");
  visit("scale", o.scale, "spread the closures' change of scale as well (Sim(3) chains)");
}

}  // namespace loopbench

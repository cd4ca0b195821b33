/// The closing error of each loop spread along the loop: the usual baseline.
#pragma once

#include "methods/correctors/shares.hpp"
#include "methods/method.hpp"

namespace loopbench {

/// For a closure a -> b with measured pose X_a L of b and cumulative share w_i, w_a = 0, w_b = 1:
///
///     dR = R_target R_b^T,  o = p_a,  dt = p_target - (dR (p_b - o) + o)
///     R_i' = Exp(w_i Log dR) R_i
///     p_i' = Exp(w_i Log dR) (p_i - o) + o + w_i dt
///
/// and the poses after b move rigidly with b. The pivot is the loop's start, so the result does
/// not depend on where the world is. Information matrices are not used.
///
/// Several loops are closed one after the other, by (to, from). What a loop may bend when it
/// overlaps one that is closed already is the option `overlap`.
///
/// Complexity O(keyframes + sum of loop lengths). Source: the rotation part as in Surmann,
/// Nuechter et al. (6D SLAM) and Sprickerhof et al. (ELCH), pivot moved to the loop's start.
class Uniform final : public Corrector {
 public:
  enum class Turn { none, slerp };

  struct Options {
    Turn rotation = Turn::slerp;
    StepWeights weights = StepWeights::index;
    LoopOverlap overlap = LoopOverlap::whole;
  };
  explicit Uniform(const Options& options) : options_(options) {}

  std::optional<std::string> declines(const Problem& problem) const override;

  /// Counts: `closures`, `largest_gap_left` [m] over all closures after the last one was closed.
  /// Throws std::runtime_error when closures are not sorted by (to, from) or name no keyframe.
  Trajectory correct(const Problem& problem, Report& report) const override;

 private:
  Options options_;
};

inline auto choices(Uniform::Turn) {
  return std::array{std::pair{"none", Uniform::Turn::none},
                    std::pair{"slerp", Uniform::Turn::slerp}};
}

template <class Visit>
void fields(Uniform::Options& o, Visit visit) {
  visit("rotation", o.rotation, "none: only positions move; slerp: attitude is spread as well");
  visit("weights", o.weights, "what a step's share of the error is proportional to");
  visit("overlap",
        o.overlap,
        "whole: every loop bends all its steps, opening earlier loops it overlaps again; "
        "open: steps inside an earlier loop keep their shape, so every loop stays closed");
}

}  // namespace loopbench

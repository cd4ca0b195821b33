/// Explicit loop closing heuristic: the closing error spread by distance in the pose graph.
#pragma once

#include "methods/correctors/shares.hpp"
#include "methods/method.hpp"

namespace loopbench {

/// For each closure a -> b, by (to, from): the shortest path from a to b in the graph of odometry
/// and of closures taken before; keyframes on it get the share w = d(a, i) / d(a, b), all others
/// that of the path keyframe they are nearest to. Then, with the pivot at the loop's start,
///
///     R_i' = Exp(w_i Log dR) R_i,   p_i' = Exp(w_i Log dR) (p_i - o) + o + w_i dt
///
/// for every keyframe, so that branches and crossings move as one. Without earlier closures this is
/// `uniform`. Complexity O(K n log n) for n keyframes and K closures.
///
/// Source: Sprickerhof, Nuechter, Lingemann, Hertzberg, ECMR 2009; the pivot is moved from the
/// world's origin (as common code has it) to the loop's start, so the world does not matter.
class Elch final : public Corrector {
 public:
  struct Options {
    StepWeights weights = StepWeights::index;
  };
  explicit Elch(const Options& options) : options_(options) {}

  std::optional<std::string> declines(const Problem& problem) const override;

  /// Counts: `closures`, `largest_gap_left` [m]. Throws std::runtime_error when closures are not
  /// sorted by (to, from) or name no keyframe.
  Trajectory correct(const Problem& problem, Report& report) const override;

 private:
  Options options_;
};

template <class Visit>
void fields(Elch::Options& o, Visit visit) {
  visit("weights", o.weights, "what the length of a step in the graph is");
}

}  // namespace loopbench

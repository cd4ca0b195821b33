/// Explicit loop closing heuristic: distributes the closing error by distance in the pose graph.
#pragma once

#include "methods/correctors/shares.hpp"

namespace loopbench::methods {

/// Processes the closures a -> b in the order (to, from). For each, it finds the shortest path from
/// a to b, by number of edges, in the graph of odometry and earlier closures. A keyframe i on the
/// path gets the share w_i = d(a, i) / d(a, b); every other keyframe gets the share of the nearest
/// path keyframe. With the pivot o at the loop's start,
///
///     R_i' = Exp(w_i Log dR) R_i,   p_i' = Exp(w_i Log dR) (p_i - o) + o + w_i dt
///
/// for every keyframe, so branches and crossings move together. Without earlier closures this
/// equals `uniform`. O(K n log n) for n keyframes and K closures.
///
/// Source: Sprickerhof, Nuechter, Lingemann, Hertzberg, ECMR 2009. The pivot is the loop's start
/// instead of the world's origin as in common code, so the result does not depend on the world
/// frame.
class Elch final : public LoopCorrector {
 public:
  using Options = NoOptions;
  explicit Elch(const Options&) {}

  /// Counts: `closures`, `largest_closing_error` [m]. Throws std::runtime_error when closures are
  /// not sorted by (to, from) or refer to a missing keyframe.
  Trajectory correct(const Problem& problem, Report& report) const override;
};

}  // namespace loopbench::methods

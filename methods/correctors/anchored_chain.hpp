/// A chain with anchors as a chain with loops.
#pragma once

#include <optional>
#include <vector>

#include "datasets/core/problem.hpp"
#include "methods/correctors/anchors.hpp"

namespace loopbench::methods {

/// An anchor is a loop from a keyframe that does not move, in which only a position is measured. If
/// the first pose is held, that is the first keyframe. If it is free, a keyframe is put in front of
/// it, at the same pose, and joined to it by an edge with a wide covariance: the size of the chain
/// [m] (at least 1 m) and 1 rad. This edge costs nothing once the first pose no longer moves, so
/// solve again from each solution until it does not (a proximal point iteration).
struct AnchoredChain {
  Problem problem;                             ///< odometry and loops; closures, then anchors
  std::vector<std::optional<Vector3>> points;  ///< of LoopedChain, one per closure
  bool has_front = false;                      ///< a keyframe was put in front

  AnchoredChain(const Problem& of, const UsedAnchors& used);

  /// Largest distance from the first keyframe, at least 1 [m].
  double size() const { return size_; }

  /// Returns the keyframes of the original problem. O(keyframes).
  Trajectory without_front(Trajectory keyframes) const;

 private:
  double size_;
};

}  // namespace loopbench::methods

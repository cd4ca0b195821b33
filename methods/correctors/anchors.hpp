/// Anchors in correctors: world frame, first pose, and distribution of their errors.
#pragma once

#include <string>
#include <vector>

#include "datasets/core/problem.hpp"
#include "methods/report.hpp"

namespace loopbench::methods {

/// Returns why the anchors cannot be used: an edge changes the scale. Empty if they can.
std::string anchors_fault(const Problem& problem);

/// The anchors of a problem as correctors use them.
struct UsedAnchors {
  /// Those of the problem; if it is planar, projected to the plane of the first keyframe.
  std::vector<Anchor> anchors;
  bool planar = false;
  bool level = false;  ///< poses have a vertical z axis, see LevelledProblem
  /// The anchors determine the world frame, so that the first pose is estimated, too: their
  /// distance from a straight line (in the plane, and the horizontal one of level poses: from their
  /// mean) exceeds three standard deviations, rms. Otherwise the first pose is held; the anchors
  /// must be in its world frame, and those at it have no effect.
  bool is_first_free = false;

  explicit UsedAnchors(const Problem& problem, bool is_level = false);

  /// Returns the rigid motion of the poses (in the plane: of x, y and yaw; level: also of z) after
  /// which the anchors have the least squared errors, not weighted; the identity if the first pose
  /// is held. Source: Umeyama, PAMI 1991.
  Pose alignment(const Trajectory& poses) const;

  /// Degrees of freedom that anchors add to those of the edges: their coordinates, minus the first
  /// pose if it is estimated.
  std::size_t degrees_of_freedom() const;

  /// Adds a note if there are anchors and the first pose is held.
  void report_held_pose(Report& report) const;
};

/// Moves the poses to the anchors: poses are aligned, then shifted by the anchors' errors, which
/// are distributed over the steps between neighbouring anchors by `shares` as of loop_shares(). The
/// shift is constant after the last anchor, and before the first one if the first pose is free;
/// otherwise it grows from zero there. Anchors at one keyframe are averaged by information;
/// covariances have no other effect, and rotations change only by the alignment. Adds the count
/// `largest_anchor_error` [m] after the shift. O(keyframes + anchors).
void distribute_anchor_errors(Trajectory& poses,
                              const Problem& problem,
                              const std::vector<double>& shares,
                              Report& report);

}  // namespace loopbench::methods

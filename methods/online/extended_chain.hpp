/// Poses between updates: the last solution, extended by odometry.
#pragma once

#include "datasets/core/problem.hpp"

namespace loopbench::methods {

/// Poses of the keyframes up to the newest one.
class ExtendedChain {
 public:
  /// `problem` must outlive this object; only its keyframes and odometry are used.
  explicit ExtendedChain(const Problem& problem) : problem_(problem) {}

  /// Appends the poses of the keyframes up to index `count` - 1: each is the one before it times
  /// the odometry edge between them, or the tracker's relative pose if there is none. On Sim(3)
  /// chains, the motion is scaled by that of the last solution at its end. O(log n) per keyframe.
  void extend(std::size_t count);

  /// Replaces all poses by a solution, one pose per keyframe known so far.
  void replace(Trajectory solved);

  /// Replaces all poses by odometry alone.
  void restart();

  const Trajectory& poses() const { return poses_; }

 private:
  /// Motion from keyframe i - 1 to keyframe i, and its scale.
  struct Step {
    Pose motion;
    double scale = 1.0;
  };
  Step step_to(std::size_t i) const;

  const Problem& problem_;
  Trajectory poses_;
  double scale_ = 1.0;  ///< of the odometry at the newest keyframe, in the scale of the poses
};

}  // namespace loopbench::methods

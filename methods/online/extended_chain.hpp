/// Poses between updates: the last solution, extended by odometry.
#pragma once

#include <algorithm>

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

inline ExtendedChain::Step ExtendedChain::step_to(std::size_t i) const {
  const auto edge = std::ranges::lower_bound(problem_.odometry, i - 1, {}, &Edge::from);
  if (edge != problem_.odometry.end() && edge->from == i - 1) {
    return {edge->from_from_to, edge->scale};
  }
  const Trajectory& keyframes = problem_.keyframes;
  return {keyframes[i - 1].world_from_body.inverse() * keyframes[i].world_from_body};
}

inline void ExtendedChain::extend(std::size_t count) {
  for (std::size_t i = poses_.size(); i < count; ++i) {
    if (i == 0) {
      poses_.push_back(problem_.keyframes.front());
      continue;
    }
    Step step = step_to(i);
    step.motion.translation *= scale_;
    scale_ *= step.scale;
    poses_.push_back(
        {problem_.keyframes[i].stamp, normalized(poses_.back().world_from_body * step.motion)});
  }
}

inline void ExtendedChain::restart() {
  const std::size_t count = poses_.size();
  poses_.clear();
  scale_ = 1.0;
  extend(count);
}

inline void ExtendedChain::replace(Trajectory solved) {
  poses_ = std::move(solved);
  scale_ = 1.0;
  double change = 1.0;  // of the scale from keyframe i - 1 to the newest one
  for (std::size_t i = poses_.size(); i-- > 1;) {
    const Step step = step_to(i);
    if (step.scale == 1.0) return;  // a rigid chain
    change *= step.scale;
    const double measured = step.motion.translation.norm();
    if (!(measured > 0.0)) continue;  // at rest
    const Vector3 motion =
        poses_[i].world_from_body.translation - poses_[i - 1].world_from_body.translation;
    scale_ = motion.norm() / measured * change;
    return;
  }
}

}  // namespace loopbench::methods

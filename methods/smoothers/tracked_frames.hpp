/// Uses the tracked frames between the keyframes: the trajectory of the SLAM system before any
/// smoothing.
#pragma once

#include "datasets/core/polyline.hpp"
#include "methods/method.hpp"

namespace loopbench::methods {

/// Linear interpolation and slerp through keyframes and tracked frames. A preceding corrector moves
/// every frame with the corrections of the two keyframes around it, interpolated by time
/// (with_keyframes), so frames stay attached to the corrected keyframes. This is the baseline for
/// smoothers of keyframes, rather than the polyline of the keyframes alone. Without frames the
/// curve equals that polyline. O(keyframes + frames) to construct, O(1) amortised per query.
class TrackedFrames final : public Smoother {
 public:
  using Options = NoOptions;
  explicit TrackedFrames(const Options&) {}

  /// Declines problems without keyframes, or without a tracked frame between them.
  std::string why_declined(const Problem& problem) const override {
    if (problem.keyframes.empty()) return "no keyframes";
    if (with_frames(problem).size() > problem.keyframes.size()) return "";
    return "no tracked frames between the keyframes";
  }

  /// Counts: `frames`, the number of frames used.
  std::unique_ptr<const Curve> smooth(const Problem& problem, Report& report) const override {
    Trajectory poses = with_frames(problem);
    report.count("frames", static_cast<double>(poses.size() - problem.keyframes.size()));
    return std::make_unique<Polyline>(std::move(poses));
  }

 private:
  /// Returns the keyframes and the frames strictly between them, sorted by stamp.
  static Trajectory with_frames(const Problem& problem) {
    Trajectory out;
    out.reserve(problem.keyframes.size() + problem.frames.size());
    auto frame = problem.frames.begin();
    for (const StampedPose& keyframe : problem.keyframes) {
      for (; frame != problem.frames.end() && frame->stamp <= keyframe.stamp; ++frame) {
        if (!out.empty() && frame->stamp < keyframe.stamp) out.push_back(*frame);
      }
      out.push_back(keyframe);
    }
    return out;
  }
};

}  // namespace loopbench::methods

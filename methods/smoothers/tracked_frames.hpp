/// The tracked frames between the keyframes: the estimate that a system leaves before any
/// smoothing.
#pragma once

#include "datasets/core/polyline.hpp"
#include "methods/method.hpp"

namespace loopbench {

/// Straight lines and great arcs through keyframes and frames. A corrector before it moves every
/// frame with the corrections of the two keyframes around it, blended by time (with_keyframes), so
/// that frames stay attached to the corrected keyframes. A smoother of keyframes earns its place
/// when it beats this, not the polyline of the keyframes alone. Without frames the curve is that
/// polyline. O(keyframes + frames) to make, O(1) amortised to ask.
class TrackedFrames final : public Smoother {
 public:
  struct Options {};
  explicit TrackedFrames(const Options&) {}

  /// Without keyframes, or without a tracked frame between them.
  std::optional<std::string> declines(const Problem& problem) const override {
    if (problem.keyframes.empty()) return "no keyframes";
    if (with_frames(problem).size() > problem.keyframes.size()) return std::nullopt;
    return "no tracked frames between the keyframes";
  }

  /// Counts the frames used as `frames`.
  std::unique_ptr<const Curve> smooth(const Problem& problem, Report& report) const override {
    Trajectory poses = with_frames(problem);
    report.count("frames", static_cast<double>(poses.size() - problem.keyframes.size()));
    return std::make_unique<Polyline>(std::move(poses));
  }

 private:
  /// Keyframes and the frames strictly between them, by stamp.
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

template <class Visit>
void fields(TrackedFrames::Options&, Visit) {}

}  // namespace loopbench

/// The points in space that the last keyframes saw.
#pragma once

#include <cstdint>
#include <vector>

#include "datasets/rgbd/camera.hpp"
#include "datasets/rgbd/features/features.hpp"
#include "datasets/rgbd/features/matching.hpp"

namespace loopbench {

class LocalMap {
 public:
  const std::vector<Seen>& points() const { return points_; }
  const Features& looks() const { return looks_; }  ///< row k belongs to points()[k]

  /// Keyframe, counted from 0, that saw point k last.
  std::size_t last_seen(std::size_t k) const { return last_seen_[k]; }

  /// Takes in keyframe `keyframe`: what it matched (a: point, b: feature) is moved to the mean
  /// weighted by inverse variance of depth and looks as it does now; what has depth and matched
  /// nothing becomes a point; what no keyframe has seen since `window` keyframes is forgotten.
  /// O(points + features).
  void add(std::size_t keyframe,
           std::size_t window,
           const Features& features,
           const std::vector<Match>& matches,
           const Camera& camera,
           const Pose& world_from_camera);

  /// Points that `keyframe` saw: each place in space once, which older points may repeat.
  /// O(points).
  std::vector<std::size_t> seen_by(std::size_t keyframe) const;

  void clear() { *this = {}; }

 private:
  void forget(std::size_t before);

  std::vector<Seen> points_;
  std::vector<double> weights_;
  std::vector<std::size_t> last_seen_;
  Features looks_;
};

}  // namespace loopbench

/// Local map: 3D points observed in the last keyframes.
#pragma once

#include <cstdint>
#include <vector>

#include "datasets/rgbd/features/features.hpp"
#include "datasets/rgbd/features/matching.hpp"
#include "datasets/rgbd/images/camera.hpp"

namespace loopbench::rgbd {

class LocalMap {
 public:
  const std::vector<MapPoint>& points() const { return points_; }
  const Features& descriptors() const { return features_; }  ///< descriptor row k of points()[k]

  /// Index of the last keyframe that observed point k.
  std::size_t last_keyframe_of(std::size_t k) const { return last_seen_[k]; }

  /// Adds a keyframe. Matched points (a: point, b: feature) are updated to the mean weighted by the
  /// inverse variance of depth, and their descriptors are replaced. Unmatched features with depth
  /// become new points. Points not observed in the last `window` keyframes are removed. O(points +
  /// features).
  void add(std::size_t keyframe,
           std::size_t window,
           const Features& features,
           const std::vector<Match>& matches,
           const Camera& camera,
           const Pose& world_from_camera);

  /// Indices of the points last observed in `keyframe`. O(points).
  std::vector<std::size_t> points_last_seen_in(std::size_t keyframe) const;

  void clear() { *this = {}; }

 private:
  void forget(std::size_t before);

  std::vector<MapPoint> points_;
  std::vector<double> weights_;
  std::vector<std::size_t> last_seen_;
  Features features_;
};

}  // namespace loopbench::rgbd

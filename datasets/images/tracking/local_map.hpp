/// Local map: 3D points observed in the last keyframes.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "datasets/images/features/features.hpp"
#include "datasets/images/features/matching.hpp"
#include "datasets/images/frames/camera.hpp"

namespace loopbench::rgbd {

inline constexpr double kMaxObservations = 10.0;  // limit of the accumulated weight of a point

/// Inverse variance up to a factor: the standard deviation of depth is proportional to its square.
inline double weight_at(double depth) { return 1.0 / (depth * depth * depth * depth); }

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
           const Pose& world_from_camera) {
    features_.bytes = features.bytes;
    features_.binary = features.binary;
    const auto bytes = static_cast<std::size_t>(features.bytes);
    const auto position = [&](const Feature& f) { return world_from_camera * point_of(f, camera); };
    std::vector<bool> matched(features.size(), false);
    for (const Match& match : matches) {
      matched[match.b] = true;
      const Feature& feature = features.points[match.b];
      MapPoint& point = points_[match.a];
      if (feature.depth > 0.0f) {
        const double weight = weight_at(static_cast<double>(feature.depth));
        double& sum = weights_[match.a];
        point.in_world = (sum * point.in_world + weight * position(feature)) / (sum + weight);
        sum = std::min(sum + weight, kMaxObservations * weight);
      }
      point.octave = feature.octave;
      last_seen_[match.a] = keyframe;
      std::copy_n(
          features.descriptor(match.b), bytes, features_.descriptors.data() + match.a * bytes);
    }
    if (keyframe >= window) forget(keyframe - window + 1);
    for (std::size_t i = 0; i < features.size(); ++i) {
      const Feature& feature = features.points[i];
      if (matched[i] || !(feature.depth > 0.0f)) continue;
      points_.push_back({position(feature), feature.octave, points_.size()});
      weights_.push_back(weight_at(static_cast<double>(feature.depth)));
      last_seen_.push_back(keyframe);
      features_.points.push_back(feature);
      const std::uint8_t* row = features.descriptor(i);
      features_.descriptors.insert(features_.descriptors.end(), row, row + bytes);
    }
  }

  /// Indices of the points last observed in `keyframe`. O(points).
  std::vector<std::size_t> points_last_seen_in(std::size_t keyframe) const {
    std::vector<std::size_t> out;
    for (std::size_t k = 0; k < points_.size(); ++k) {
      if (last_seen_[k] == keyframe) out.push_back(k);
    }
    return out;
  }

  void clear() { *this = {}; }

 private:
  void forget(std::size_t before) {
    const auto bytes = static_cast<std::size_t>(features_.bytes);
    std::size_t kept = 0;
    for (std::size_t k = 0; k < points_.size(); ++k) {
      if (last_seen_[k] < before) continue;
      points_[kept] = points_[k];
      points_[kept].row = kept;
      weights_[kept] = weights_[k];
      last_seen_[kept] = last_seen_[k];
      features_.points[kept] = features_.points[k];
      if (kept != k) {
        std::copy_n(features_.descriptor(k), bytes, features_.descriptors.data() + kept * bytes);
      }
      ++kept;
    }
    points_.resize(kept);
    weights_.resize(kept);
    last_seen_.resize(kept);
    features_.points.resize(kept);
    features_.descriptors.resize(kept * bytes);
  }

  std::vector<MapPoint> points_;
  std::vector<double> weights_;
  std::vector<std::size_t> last_seen_;
  Features features_;
};

}  // namespace loopbench::rgbd

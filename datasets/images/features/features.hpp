/// Image features with descriptors and depth.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "datasets/core/fields.hpp"
#include "datasets/images/frames/camera.hpp"
#include "datasets/images/frames/image.hpp"

namespace loopbench::rgbd {

struct Feature {
  float u = 0.0f;      ///< undistorted [px]
  float v = 0.0f;      ///< undistorted [px]
  float depth = 0.0f;  ///< [m]; 0: not measured or next to a depth edge
  float sigma = 1.0f;  ///< pixel size of the pyramid level relative to the image [-]
  std::int32_t octave = 0;
};

/// Position of a feature with depth, in camera axes [m].
inline Vector3 point_of(const Feature& feature, const Camera& camera) {
  return camera.back_project(static_cast<double>(feature.u),
                             static_cast<double>(feature.v),
                             static_cast<double>(feature.depth));
}

/// Row i of `descriptors` (`bytes` long) belongs to points[i].
struct Features {
  std::vector<Feature> points = {};
  std::vector<std::uint8_t> descriptors = {};
  std::int32_t bytes = 32;
  bool binary = true;  ///< Hamming distance, else Euclidean distance

  std::size_t size() const { return points.size(); }
  const std::uint8_t* descriptor(std::size_t i) const {
    return descriptors.data() + i * static_cast<std::size_t>(bytes);
  }
};

enum class FeatureKind { orb, akaze, sift };
inline auto choices(FeatureKind) {
  return std::array{std::pair{"orb", FeatureKind::orb},
                    std::pair{"akaze", FeatureKind::akaze},
                    std::pair{"sift", FeatureKind::sift}};
}

struct FeatureOptions {
  FeatureKind kind = FeatureKind::orb;
  std::int64_t count = 800;
  double depth_max = 5.0;  ///< [m]
};

template <class Visit>
void fields(FeatureOptions& o, Visit visit) {
  visit("features.kind", o.kind, "detector and descriptor");
  visit("features.count", o.count, "maximum number of features per image", Between{50, 10000});
  visit("features.depth_max", o.depth_max, "maximum depth that is used [m]", GreaterThan{0});
}

/// Detects four times `count` features and keeps the strongest ones of each grid cell, for an even
/// distribution over the image. Bit-identical for any number of threads. O(pixels).
Features find_features(const RgbdFrame& frame, const Camera& camera, const FeatureOptions& options);

/// Descriptor distance in 0..1: share of different bits, or half the distance of unit vectors
/// (SIFT). It is about 0.5 for unrelated descriptors.
float descriptor_distance(const Features& a, std::size_t i, const Features& b, std::size_t k);

}  // namespace loopbench::rgbd

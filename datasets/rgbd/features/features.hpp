/// Points of an image that can be found again, with what they look like and how far they are.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "datasets/core/fields.hpp"
#include "datasets/rgbd/camera.hpp"
#include "datasets/rgbd/image.hpp"

namespace loopbench {

struct Feature {
  float u = 0.0f;      ///< undistorted [px]
  float v = 0.0f;      ///< undistorted [px]
  float depth = 0.0f;  ///< [m]; 0: none, or beside a depth edge
  float sigma = 1.0f;  ///< size of a pixel where it was found, over one of the image [-]
  std::int32_t octave = 0;
};

/// Row i of `descriptors` (`bytes` long) belongs to points[i].
struct Features {
  std::vector<Feature> points = {};
  std::vector<std::uint8_t> descriptors = {};
  std::int32_t bytes = 32;
  bool binary = true;  ///< bits that differ count, else Euclidean distance

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
  std::int64_t cells = 12;
  double depth_max = 5.0;  ///< [m]
};

template <class Visit>
void fields(FeatureOptions& o, Visit visit) {
  visit("features.kind", o.kind, "detector and descriptor");
  visit("features.count", o.count, "kept in an image", Between{50, 10000});
  visit("features.cells", o.cells, "columns of the grid they are spread over", Between{1, 100});
  visit("features.depth_max", o.depth_max, "farther depth is not believed [m]", Above{0});
}

/// Detects four times as many as asked for and keeps the strongest of every grid cell, so that one
/// rich corner of the image does not take all. Same bits on any number of threads. O(pixels).
Features find_features(const RgbdFrame& frame, const Camera& camera, const FeatureOptions& options);

/// 0..1: share of bits that differ, or distance of unit vectors over 2 (SIFT, kept in bytes).
/// Unrelated descriptors are about 0.5 apart either way.
float descriptor_distance(const Features& a, std::size_t i, const Features& b, std::size_t k);

}  // namespace loopbench

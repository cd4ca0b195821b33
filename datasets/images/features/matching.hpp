/// Feature matching: exhaustive, or guided by a predicted pose.
#pragma once

#include <cstddef>
#include <vector>

#include "datasets/core/pose.hpp"
#include "datasets/images/features/features.hpp"

namespace loopbench::rgbd {

struct Match {
  std::size_t a = 0;
  std::size_t b = 0;
  float distance = 0.0f;  ///< 0..1
};

inline constexpr double kMaxDistance = 0.25;  ///< of the descriptors of a match, 0..1 [-]
inline constexpr double kMaxRatio = 0.85;     ///< of best and second best descriptor distance [-]
inline constexpr double kMatchRadius = 0.06;  ///< of the guided search / image width [-]

/// Matches features by descriptor with ratio test and mutual check. Sorted by a. O(|a| |b|).
std::vector<Match> match_exhaustive(const Features& a, const Features& b);

/// A map point.
struct MapPoint {
  Vector3 in_world;         ///< point in the world frame [m]
  std::int32_t octave = 0;  ///< pyramid level of the last observation
  std::size_t row = 0;      ///< row of its descriptor
};

/// Matches each map point (index a) with the feature (index b) of smallest descriptor distance
/// within `radius` [px] of its projection, plus one pixel per octave. The ratio test uses features
/// of similar octaves. Each feature is matched once, with the point of smallest distance.
/// `descriptors` holds the rows of the points. Sorted by b. O(points * features in the circle).
std::vector<Match> match_guided(const std::vector<MapPoint>& points,
                                const Features& descriptors,
                                const Features& features,
                                const Camera& camera,
                                const Pose& world_from_camera,
                                double radius);

}  // namespace loopbench::rgbd

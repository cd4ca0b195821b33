/// Feature matching: exhaustive, or guided by a predicted pose.
#pragma once

#include <cstddef>
#include <vector>

#include "datasets/core/pose.hpp"
#include "datasets/rgbd/features/features.hpp"

namespace loopbench::rgbd {

struct Match {
  std::size_t a = 0;
  std::size_t b = 0;
  float distance = 0.0f;  ///< 0..1
};

struct MatchOptions {
  double distance_max = 0.25;
  double ratio = 0.85;
  double radius = 0.06;
};

template <class Visit>
void fields(MatchOptions& o, Visit visit) {
  visit("match.distance_max",
        o.distance_max,
        "maximum descriptor distance of a match, 0..1 [-]",
        Between{0, 1});
  visit("match.ratio",
        o.ratio,
        "maximum ratio of best and second best descriptor distance [-]",
        Between{0, 1});
  visit("match.radius",
        o.radius,
        "radius of the guided search relative to the image width [-]",
        Between{0, 1});
}

/// Matches features by descriptor with ratio test and mutual check. Sorted by a. O(|a| |b|).
std::vector<Match> match_exhaustive(const Features& a, const Features& b, const MatchOptions& o);

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
                                double radius,
                                const MatchOptions& o);

}  // namespace loopbench::rgbd

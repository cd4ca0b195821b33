/// Which feature is which: everywhere by looks, or near where motion says it must be.
#pragma once

#include <cstddef>
#include <vector>

#include "datasets/core/pose.hpp"
#include "datasets/rgbd/features/features.hpp"

namespace loopbench {

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
  visit("match.distance_max", o.distance_max, "share of bits that may differ [-]", Between{0, 1});
  visit("match.ratio", o.ratio, "best over second best distance, at most [-]", Between{0, 1});
  visit("match.radius", o.radius, "of the guided search, over image width [-]", Between{0, 1});
}

/// Every feature of `a` with its nearest of `b` by looks, when the second nearest is clearly
/// farther and the choice is mutual. Sorted by a. O(|a| |b|).
std::vector<Match> match_everywhere(const Features& a, const Features& b, const MatchOptions& o);

/// A point in space that was seen before.
struct Seen {
  Vector3 in_world;         ///< [m]
  std::int32_t octave = 0;  ///< at which it was seen last
  std::size_t row = 0;      ///< of its descriptor
};

/// Every seen point (index a) with the feature (index b) that looks most like it within `radius`
/// [px] of where it projects, about a pixel larger at coarser octaves. Ratio test among features of
/// near octaves, and no feature twice: the point that looks most like it has it. Sorted by b.
/// O(points * features in the circle).
std::vector<Match> match_near(const std::vector<Seen>& points,
                              const Features& looks,
                              const Features& features,
                              const Camera& camera,
                              const Pose& world_from_camera,
                              double radius,
                              const MatchOptions& o);

}  // namespace loopbench

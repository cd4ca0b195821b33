/// Revisited places of a trajectory: candidates for loop closures.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "datasets/core/trajectory.hpp"
#include "datasets/derive/view.hpp"

namespace loopbench {

struct RevisitRule {
  double radius = 0.5;   ///< maximum distance [m]
  double angle = 0.5;    ///< maximum rotation angle between the poses [rad]
  double min_gap = 5.0;  ///< minimum time between the poses [s]
  /// Instead of radius and angle: its largest range, and the share of its volume.
  std::optional<View> view = {};
};

struct Revisit {
  std::size_t from;  ///< the earlier pose
  std::size_t to;
};
inline bool operator==(const Revisit& a, const Revisit& b) {
  return a.from == b.from && a.to == b.to;
}

/// Returns for each pose the nearest earlier pose that satisfies `rule`, if any; ties are resolved
/// in favour of the earliest. Sorted by `to`. rule.radius must be positive. Only the latest 64
/// poses in each cube of side `radius` are compared, so that the cost is O(n) also for a body at
/// rest. With a view, all poses in reach are compared: O(n + pairs in reach).
std::vector<Revisit> find_revisits(const Trajectory& poses, const RevisitRule& rule);

/// Subsamples at most `count` revisits by farthest-point sampling in the plane (stamp of from,
/// stamp of to), starting with the longest loop. Returns ascending indices. O(revisits * count).
std::vector<std::size_t> subsample(const std::vector<Revisit>& revisits,
                                   const std::vector<double>& stamps,
                                   std::size_t count);

}  // namespace loopbench

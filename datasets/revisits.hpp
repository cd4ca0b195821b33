/// Places a path comes back to: where a loop could be closed.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "datasets/core/trajectory.hpp"

namespace loopbench {

struct RevisitRule {
  double radius = 0.5;   ///< largest distance [m]
  double angle = 0.5;    ///< largest difference of attitude [rad]
  double min_gap = 5.0;  ///< least time between the two [s]
};

struct Revisit {
  std::size_t from;  ///< the earlier pose
  std::size_t to;
};
inline bool operator==(const Revisit& a, const Revisit& b) {
  return a.from == b.from && a.to == b.to;
}

/// For each pose the nearest earlier one that obeys the rule, if any; the earliest of equals.
/// Sorted by `to`. Of a place where one lingers only the latest 64 poses in a cube of `radius` are
/// looked at, so the cost stays O(n). radius > 0.
std::vector<Revisit> find_revisits(const Trajectory& poses, const RevisitRule& rule);

/// Ascending indices of at most `count` revisits spread well over (stamp of from, stamp of to):
/// first the longest loop, then always the one farthest from those taken. O(revisits * count).
std::vector<std::size_t> spread(const std::vector<Revisit>& revisits,
                                const std::vector<double>& stamps,
                                std::size_t count);

}  // namespace loopbench

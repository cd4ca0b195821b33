/// Ends of sub-trajectories of a given length.
#pragma once

#include <vector>

#include "metrics/pairing/pair_search.hpp"
#include "metrics/protocols/protocol.hpp"

namespace loopbench::metrics {

/// Pairs of start and end on `distances` (accumulated, never decreasing) by the rule `end`, for
/// starts `step` apart. rpg: trajectory_utils.py:25-37 (8c8ceec), KITTI: evaluate_odometry.cpp
/// (2afdb93). O(n) for all rules; `nearest` takes O(log n) for a start whose end does not move.
std::vector<FromTo> segment_pairs(const std::vector<double>& distances,
                                  double length,
                                  double tolerance,
                                  SegmentEnd end,
                                  std::size_t step);

/// SegmentEnd::beyond computed with the type Real.
template <class Real>
std::vector<FromTo> segments_beyond(const std::vector<Real>& distances,
                                    Real length,
                                    std::size_t step) {
  std::vector<FromTo> out;
  std::size_t end = 0;
  for (std::size_t start = 0; start < distances.size(); start += step) {
    while (end < distances.size() && !(distances[end] > distances[start] + length)) ++end;
    if (end == distances.size()) break;  // later starts reach even further
    out.emplace_back(start, end);
  }
  return out;
}

}  // namespace loopbench::metrics

/// Ends of sub-trajectories of a given length.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "datasets/core/parallel.hpp"
#include "metrics/pairing/pair_search.hpp"
#include "metrics/protocols/protocol.hpp"

namespace loopbench::metrics {

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

using DistanceAt = std::vector<double>::const_iterator;

/// The first index, not before `from`, with the same distance as `last`.
inline DistanceAt first_of_run(DistanceAt from, DistanceAt last) {
  if (last == from || *std::prev(last) < *last) return last;
  return std::lower_bound(from, last, *last);
}

inline std::vector<FromTo> nearest(const std::vector<double>& distances,
                                   double length,
                                   double tolerance,
                                   std::size_t step) {
  constexpr std::size_t kNoEnd = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> ends((distances.size() + step - 1) / step, kNoEnd);
  parallel_for_blocks(ends.size(), [&](std::size_t k, std::size_t last) {
    if (k == last) return;
    const auto at = [&](std::size_t i) {
      return distances.begin() + static_cast<std::ptrdiff_t>(i * step);
    };
    // Bisection for the first start, linear search for the others: the distance never decreases.
    DistanceAt beyond = std::lower_bound(at(k), distances.end(), *at(k) + length);
    for (; k < last; ++k) {
      const DistanceAt from = at(k);
      const double wanted = *from + length;
      beyond = std::max(beyond, from);
      while (beyond != distances.end() && *beyond < wanted) ++beyond;
      DistanceAt best = beyond;
      const bool is_before =
          best != from &&
          (best == distances.end() || wanted - *std::prev(best) <= std::abs(*best - wanted));
      // At rest the distance repeats: take the first of the equal values, as a scan with `<` would.
      if (is_before) best = first_of_run(from, std::prev(best));
      if (best == distances.end() || !(std::abs(*best - wanted) < tolerance)) continue;
      ends[k] = static_cast<std::size_t>(best - distances.begin());
    }
  });
  std::vector<FromTo> out;
  out.reserve(ends.size() - static_cast<std::size_t>(std::ranges::count(ends, kNoEnd)));
  for (std::size_t k = 0; k < ends.size(); ++k) {
    if (ends[k] != kNoEnd) out.emplace_back(k * step, ends[k]);
  }
  return out;
}

/// Pairs of start and end on `distances` (accumulated, never decreasing) by the rule `end`, for
/// starts `step` apart. rpg: trajectory_utils.py:25-37 (8c8ceec), KITTI: evaluate_odometry.cpp
/// (2afdb93). O(n) for all rules; `nearest` takes O(log n) for a start whose end does not move.
inline std::vector<FromTo> segment_pairs(const std::vector<double>& distances,
                                         double length,
                                         double tolerance,
                                         SegmentEnd end,
                                         std::size_t step) {
  switch (end) {
    case SegmentEnd::beyond:
      return segments_beyond(distances, length, step);
    case SegmentEnd::nearest:
    case SegmentEnd::rpg:
      break;
  }
  std::vector<FromTo> out = nearest(distances, length, tolerance, step);
  if (end == SegmentEnd::rpg) {
    for (std::size_t k = 0; k < out.size(); ++k) out[k].first = k;
  }
  return out;
}

}  // namespace loopbench::metrics

#include "metrics/segments/ends.hpp"

#include <algorithm>
#include <cmath>

namespace loopbench {
namespace {

std::vector<FromTo> nearest(const std::vector<double>& distances,
                            double length,
                            double tolerance,
                            std::size_t step) {
  std::vector<FromTo> out;
  for (std::size_t start = 0; start < distances.size(); start += step) {
    const double wanted = distances[start] + length;
    const auto from = distances.begin() + static_cast<std::ptrdiff_t>(start);
    auto best = std::lower_bound(from, distances.end(), wanted);
    const bool is_before = best != from && (best == distances.end() ||
                                            wanted - *std::prev(best) <= std::abs(*best - wanted));
    // Standing still repeats a distance: the first of the run, as a scan with `<` would find.
    if (is_before) best = std::lower_bound(from, best, *std::prev(best));
    if (best == distances.end() || !(std::abs(*best - wanted) < tolerance)) continue;
    out.emplace_back(start, static_cast<std::size_t>(best - distances.begin()));
  }
  return out;
}

/// The end walks on while the next pose is nearer than the end was when this start came: it runs
/// past the first length and only fits again once the starts have caught up, and when it reaches
/// the last pose all later starts are dropped.
std::vector<FromTo> eth3d(const std::vector<double>& distances, double length, double tolerance) {
  std::vector<FromTo> out;
  std::size_t end = 0;
  for (std::size_t start = 0; end + 1 < distances.size() && start < distances.size(); ++start) {
    const double wanted = distances[start] + length;
    const double at_first = std::abs(wanted - distances[end]);
    while (end + 1 < distances.size() && std::abs(wanted - distances[end + 1]) < at_first) ++end;
    if (end + 1 >= distances.size()) break;
    if (start == end || std::abs(distances[end] - distances[start] - length) > tolerance) continue;
    out.emplace_back(start, end);
  }
  return out;
}

}  // namespace

std::vector<FromTo> segment_pairs(const std::vector<double>& distances,
                                  double length,
                                  double tolerance,
                                  SegmentEnd end,
                                  std::size_t step) {
  switch (end) {
    case SegmentEnd::beyond:
      return segments_beyond(distances, length, step);
    case SegmentEnd::eth3d:
      return eth3d(distances, length, tolerance);
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

}  // namespace loopbench

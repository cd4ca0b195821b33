/// Tracking gaps: pauses of the estimate while the reference moved.
#pragma once

#include <algorithm>
#include <iterator>
#include <vector>

#include "datasets/core/problem.hpp"
#include "metrics/numerics/median.hpp"

namespace loopbench::metrics {

/// A pause of the estimate, in reference time [s].
struct TrackingGap {
  double begin = 0.0;
  double end = 0.0;
};

inline constexpr double kStanding = 0.05;  // [m/s], as in DiagnosticsOptions

/// Pauses longer than this are tracking gaps [s].
inline double longest_interval(const std::vector<double>& stamps) {
  constexpr double kMedianIntervals = 10.0;
  std::vector<double> steps;
  steps.reserve(stamps.size());
  for (std::size_t i = 1; i < stamps.size(); ++i) steps.push_back(stamps[i] - stamps[i - 1]);
  return kMedianIntervals * median(steps);
}

/// Pauses between the estimate's stamps longer than `longest_pause` [s] during which the reference
/// has poses and moved from its position with an average speed above `rest_speed` [m/s]. Keyframe
/// selection creates no keyframes at rest, and a reference gap is not an error of the estimate.
/// O(n + m).
inline std::vector<TrackingGap> gaps_while_moving(const Trajectory& reference,
                                                  const std::vector<double>& estimate,
                                                  double offset,
                                                  double longest_pause,
                                                  double rest_speed) {
  std::vector<TrackingGap> out;
  std::size_t first = 0;  // first reference pose inside the pause
  for (std::size_t i = 1; i < estimate.size(); ++i) {
    const TrackingGap pause{estimate[i - 1] + offset, estimate[i] + offset};
    const double duration = pause.end - pause.begin;
    if (!(duration > longest_pause)) continue;
    while (first < reference.size() && reference[first].stamp < pause.begin) ++first;
    double farthest = 0.0;
    bool has_reference = false;
    for (std::size_t k = first; k < reference.size() && reference[k].stamp <= pause.end; ++k) {
      has_reference |= reference[k].stamp > pause.begin && reference[k].stamp < pause.end;
      const Vector3 displacement =
          reference[k].world_from_body.translation - reference[first].world_from_body.translation;
      farthest = std::max(farthest, displacement.norm());
    }
    if (has_reference && farthest > rest_speed * duration) out.push_back(pause);
  }
  return out;
}

/// The pauses of gaps_while_moving() longer than `longest_pause` [s] that are also longer than ten
/// times the median interval between the stamps, since keyframes can be seconds apart everywhere.
/// O(n + m).
inline std::vector<TrackingGap> tracking_gaps(const Trajectory& reference,
                                              const std::vector<double>& estimate,
                                              double offset,
                                              double longest_pause) {
  std::vector<TrackingGap> out =
      gaps_while_moving(reference, estimate, offset, longest_pause, kStanding);
  if (out.empty()) return out;
  const double longest = longest_interval(estimate);
  std::erase_if(out, [&](const TrackingGap& gap) { return gap.end - gap.begin <= longest; });
  return out;
}

/// Time between the stamps that an estimate does not cover [s]: its tracking gaps, and what other
/// pauses while the reference moves exceed 5 s by: poses that are farther apart show little of the
/// path between them. O(n + m).
inline double uncovered_time(const Trajectory& reference,
                             const std::vector<double>& estimate,
                             double longest_pause) {
  constexpr double kCovered = 5.0;  // [s]
  double out = 0.0;
  const std::vector<TrackingGap> pauses =
      gaps_while_moving(reference, estimate, 0.0, longest_pause, kStanding);
  if (pauses.empty()) return out;
  const double longest = longest_interval(estimate);
  for (const TrackingGap& pause : pauses) {
    const double duration = pause.end - pause.begin;
    out += duration > longest ? duration : std::max(0.0, duration - kCovered);
  }
  return out;
}

/// Stamps at which the problem has a pose: its keyframes and the frames between them, ascending.
inline std::vector<double> tracked_stamps(const Problem& problem) {
  std::vector<double> out;
  out.reserve(problem.keyframes.size() + problem.frames.size());
  std::ranges::merge(stamps(problem.keyframes), stamps(problem.frames), std::back_inserter(out));
  return out;
}

}  // namespace loopbench::metrics

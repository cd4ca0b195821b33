#include "metrics/trajectory/tracking_gaps.hpp"

#include <algorithm>
#include <iterator>

#include "metrics/numerics/median.hpp"

namespace loopbench::metrics {
namespace {

constexpr double kStanding = 0.05;  // [m/s], as in DiagnosticsOptions

/// Pauses longer than this are tracking gaps [s].
double longest_interval(const std::vector<double>& stamps) {
  constexpr double kMedianIntervals = 10.0;
  std::vector<double> steps;
  steps.reserve(stamps.size());
  for (std::size_t i = 1; i < stamps.size(); ++i) steps.push_back(stamps[i] - stamps[i - 1]);
  return kMedianIntervals * median(steps);
}

}  // namespace

std::vector<TrackingGap> gaps_while_moving(const Trajectory& reference,
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

std::vector<TrackingGap> tracking_gaps(const Trajectory& reference,
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

double uncovered_time(const Trajectory& reference,
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

std::vector<double> tracked_stamps(const Problem& problem) {
  std::vector<double> out;
  out.reserve(problem.keyframes.size() + problem.frames.size());
  std::ranges::merge(stamps(problem.keyframes), stamps(problem.frames), std::back_inserter(out));
  return out;
}

}  // namespace loopbench::metrics

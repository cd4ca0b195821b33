#include "metrics/pairing/pair_search.hpp"

#include <algorithm>
#include <cmath>

namespace loopbench::metrics {

std::vector<FromTo> pairs_by_frames(std::size_t size, std::size_t delta) {
  std::vector<FromTo> out;
  if (size <= delta) return out;
  out.reserve(size - delta);
  for (std::size_t i = 0; i + delta < size; ++i) out.emplace_back(i, i + delta);
  return out;
}

std::vector<FromTo> pairs_by_measure(const std::vector<double>& measure,
                                     double delta,
                                     double tolerance) {
  std::vector<FromTo> out;
  out.reserve(measure.size());
  const auto at = [&](std::size_t j) { return measure.begin() + static_cast<std::ptrdiff_t>(j); };
  std::size_t beyond = 1;  // first later pose at least delta away; moves forward only
  for (std::size_t i = 0; i + 1 < measure.size(); ++i) {
    const double here = measure[i];
    beyond = std::max(beyond, i + 1);
    while (beyond < measure.size() && measure[beyond] - here < delta) ++beyond;
    std::size_t nearest = beyond;
    if (beyond > i + 1) {
      const double short_of = measure[beyond - 1] - here;
      if (beyond == measure.size() || delta - short_of <= (measure[beyond] - here) - delta) {
        // At rest the measure repeats: find the first of the equal values by bisection.
        const auto first = std::partition_point(
            at(i + 1), at(beyond), [&](double value) { return value - here < short_of; });
        nearest = static_cast<std::size_t>(first - measure.begin());
      }
    }
    if (std::abs((measure[nearest] - here) - delta) <= tolerance) out.emplace_back(i, nearest);
  }
  return out;
}

std::vector<double> accumulated_distances(const Trajectory& trajectory) {
  std::vector<double> out;
  out.reserve(trajectory.size());
  double length = 0.0;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    if (i > 0) {
      length += (trajectory[i].world_from_body.translation -
                 trajectory[i - 1].world_from_body.translation)
                    .norm();
    }
    out.push_back(length);
  }
  return out;
}

std::vector<FromTo> consecutive_frames(std::size_t size, std::size_t delta) {
  std::vector<FromTo> out;
  for (std::size_t i = 0; i + delta < size; i += delta) out.emplace_back(i, i + delta);
  return out;
}

std::vector<FromTo> consecutive_by_measure(const std::vector<double>& steps,
                                           double delta,
                                           FirstPose first) {
  std::vector<FromTo> out;
  bool has_start = first == FirstPose::starts;
  std::size_t start = 0;
  double gone = 0.0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    gone += steps[i];
    if (gone < delta) continue;
    if (has_start) out.emplace_back(start, i);
    has_start = true;
    start = i;
    gone = 0.0;
  }
  return out;
}

std::vector<FromTo> consecutive_seconds(const std::vector<double>& stamps,
                                        double delta,
                                        double tolerance) {
  std::vector<FromTo> out;
  std::size_t start = 0;
  for (const FromTo& pair : pairs_by_measure(stamps, delta, tolerance)) {
    if (pair.first < start) continue;
    out.push_back(pair);
    start = pair.second;
  }
  return out;
}

}  // namespace loopbench::metrics

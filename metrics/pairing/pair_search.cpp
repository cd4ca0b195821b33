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

}  // namespace loopbench::metrics

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

namespace {

constexpr std::size_t kLeaf = 8;    // poses checked individually
constexpr double kRounding = 1e-9;  // [rad]; margin of the bounds against rounding

/// Binary tree of trajectory intervals, each with a bound on its orientations.
class Attitudes {
 public:
  explicit Attitudes(const Trajectory& trajectory) : poses_(trajectory) {
    if (!poses_.empty()) build(0, 0, poses_.size());
  }

  /// Visits j > i with low <= angle(i, j) <= high, in order.
  template <class Visit>
  void each(std::size_t i, double low, double high, const Visit& visit) const {
    walk(0, 0, poses_.size(), {i, low, high}, visit);
  }

 private:
  struct Bound {
    Rotation middle = Rotation::Identity();
    double radius = 0.0;  ///< largest angle from the middle orientation [rad]
  };
  struct Wanted {
    std::size_t i;
    double low;
    double high;
  };

  const Rotation& attitude(std::size_t i) const { return poses_[i].world_from_body.rotation; }

  void build(std::size_t node, std::size_t begin, std::size_t end) {
    if (bounds_.size() <= node) bounds_.resize(node + 1);
    const std::size_t half = begin + (end - begin) / 2;
    Bound bound{attitude(half), 0.0};
    for (std::size_t k = begin; k < end; ++k) {
      bound.radius = std::max(bound.radius, angle_between(bound.middle, attitude(k)));
    }
    bounds_[node] = bound;
    if (end - begin <= kLeaf) return;
    build(2 * node + 1, begin, half);
    build(2 * node + 2, half, end);
  }

  template <class Visit>
  void walk(std::size_t node,
            std::size_t begin,
            std::size_t end,
            const Wanted& wanted,
            const Visit& visit) const {
    if (end <= wanted.i + 1) return;
    const Bound& bound = bounds_[node];
    const double angle = angle_between(attitude(wanted.i), bound.middle);
    if (angle + bound.radius < wanted.low - kRounding) return;
    if (angle - bound.radius > wanted.high + kRounding) return;
    if (end - begin > kLeaf) {
      const std::size_t half = begin + (end - begin) / 2;
      walk(2 * node + 1, begin, half, wanted, visit);
      walk(2 * node + 2, half, end, wanted, visit);
      return;
    }
    for (std::size_t j = std::max(begin, wanted.i + 1); j < end; ++j) {
      const double rotated = angle_between(attitude(wanted.i), attitude(j));
      if (wanted.low <= rotated && rotated <= wanted.high) visit(j);
    }
  }

  const Trajectory& poses_;
  std::vector<Bound> bounds_;
};

}  // namespace

std::vector<FromTo> angle_pairs(const Trajectory& trajectory, double angle, double tolerance) {
  std::vector<FromTo> out;
  const Attitudes attitudes(trajectory);
  for (std::size_t i = 0; i + 1 < trajectory.size(); ++i) {
    attitudes.each(
        i, angle - tolerance, angle + tolerance, [&](std::size_t j) { out.emplace_back(i, j); });
  }
  return out;
}

}  // namespace loopbench::metrics

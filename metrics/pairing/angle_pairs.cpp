#include <algorithm>

#include "metrics/pairing/pair_search.hpp"

namespace loopbench::metrics {
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

/// Piecewise linear curve (SLERP in rotation) through keyframes: the default interpolation.
#pragma once

#include <utility>

#include "datasets/core/curve.hpp"
#include "datasets/core/interpolate.hpp"
#include "datasets/core/knot_span.hpp"

namespace loopbench {

class Polyline final : public Curve {
 public:
  /// Stamps must increase, see check(). Throws std::invalid_argument for an empty trajectory.
  explicit Polyline(Trajectory poses) : poses_(std::move(poses)), stamps_(stamps(poses_)) {
    if (poses_.empty()) throw std::invalid_argument("polyline: needs at least one pose");
  }

  double start() const override { return stamps_.front(); }
  double end() const override { return stamps_.back(); }

  using Curve::sample;
  void sample(std::span<const double> times, std::span<Pose> poses) const override {
    KnotSpan span(stamps_);
    for (std::size_t k = 0; k < times.size(); ++k) {
      const std::size_t i = span.find(times[k]);
      const Pose& before = poses_[i].world_from_body;
      if (times[k] == stamps_[i]) {  // exact at the knots, without rounding
        poses[k] = before;
      } else if (times[k] == stamps_[i + 1]) {
        poses[k] = poses_[i + 1].world_from_body;
      } else {
        const double u = (times[k] - stamps_[i]) / (stamps_[i + 1] - stamps_[i]);
        poses[k] = interpolate(before, poses_[i + 1].world_from_body, u);
      }
    }
  }

 private:
  Trajectory poses_;
  std::vector<double> stamps_;
};

}  // namespace loopbench

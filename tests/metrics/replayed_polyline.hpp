/// A polyline with the record of a replay.
#pragma once

#include "datasets/core/polyline.hpp"
#include "datasets/core/replay.hpp"

namespace loopbench::test {

class ReplayedPolyline final : public Curve {
 public:
  ReplayedPolyline(const Trajectory& poses, Replay replay)
      : polyline_(poses), replay_(std::move(replay)) {}

  double start() const override { return polyline_.start(); }
  double end() const override { return polyline_.end(); }
  using Curve::sample;
  void sample(std::span<const double> times, std::span<Pose> poses) const override {
    polyline_.sample(times, poses);
  }
  const Replay* replay() const override { return &replay_; }

 private:
  Polyline polyline_;
  Replay replay_;
};

/// An update with one closure at keyframe `current`, which moves it along x from `before` to
/// `after` [m].
inline ReplayUpdate closure_at(std::size_t current, double before, double after) {
  return {static_cast<double>(current),
          current + 1,
          1,
          0.01,
          {Rotation::Identity(), {before, 0.0, 0.0}},
          {Rotation::Identity(), {after, 0.0, 0.0}}};
}

}  // namespace loopbench::test

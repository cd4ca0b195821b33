/// Combines the positions of one curve with the rotations of another over the same time span.
#pragma once

#include <memory>
#include <utility>

#include "datasets/core/curve.hpp"

namespace loopbench::methods {

class PositionAndRotationCurve final : public Curve {
 public:
  PositionAndRotationCurve(std::unique_ptr<const Curve> positions,
                           std::unique_ptr<const Curve> attitudes)
      : positions_(std::move(positions)), attitudes_(std::move(attitudes)) {}

  double start() const override { return positions_->start(); }
  double end() const override { return positions_->end(); }

  using Curve::sample;
  void sample(std::span<const double> times, std::span<Pose> poses) const override {
    attitudes_->sample(times, poses);
    std::vector<Pose> translations(times.size());
    positions_->sample(times, translations);
    for (std::size_t k = 0; k < poses.size(); ++k)
      poses[k].translation = translations[k].translation;
  }

 private:
  std::unique_ptr<const Curve> positions_;
  std::unique_ptr<const Curve> attitudes_;
};

}  // namespace loopbench::methods

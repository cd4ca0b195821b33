/// A method's curve, every pose of which is checked when it is sampled.
#pragma once

#include <mutex>
#include <string>

#include "datasets/core/curve.hpp"

namespace loopbench::harness {

/// Detects curves that return other poses later than when they were checked, or invalid ones
/// between the checked times: metrics sample at times of their own.
class CheckedCurve final : public Curve {
 public:
  /// `curve` must outlive this object.
  explicit CheckedCurve(const Curve& curve) : curve_(curve) {}

  using Curve::sample;
  double start() const override { return curve_.start(); }
  double end() const override { return curve_.end(); }

  /// Throws std::runtime_error for the first pose that violates a rule of violated_rule() or is not
  /// written. Adds O(n).
  void sample(std::span<const double> times, std::span<Pose> poses) const override;

  /// Throws the first error of sample() again, since a metric can have caught it.
  void require_valid_so_far() const;

 private:
  const Curve& curve_;
  mutable std::mutex mutex_;
  mutable std::string first_error_;
};

}  // namespace loopbench::harness

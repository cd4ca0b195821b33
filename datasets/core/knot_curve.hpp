/// A curve with one formula per interval between knots.
#pragma once

#include <utility>

#include "datasets/core/curve.hpp"
#include "datasets/core/knot_span.hpp"

namespace loopbench {

/// Derived classes evaluate one interval; this class finds it. O(n + m) for sorted times.
class KnotCurve : public Curve {
 public:
  double start() const final { return knots_.front(); }
  double end() const final { return knots_.back(); }
  const std::vector<double>& knots() const { return knots_; }  ///< [s]

  using Curve::sample;
  void sample(std::span<const double> times, std::span<Pose> poses) const final {
    KnotSpan span(knots_);
    for (std::size_t k = 0; k < times.size(); ++k) {
      poses[k] = evaluate(span.find(times[k]), times[k]);
    }
  }

 protected:
  explicit KnotCurve(std::vector<double> knots) : knots_(std::move(knots)) {}

  /// Returns world_from_body at a time in knots()[i]..knots()[i + 1].
  virtual Pose evaluate(std::size_t i, double time) const = 0;

  /// Returns the time since knots()[i] as a fraction of interval i.
  double fraction(std::size_t i, double time) const {
    return (time - knots_[i]) / (knots_[i + 1] - knots_[i]);
  }

 private:
  std::vector<double> knots_;
};

}  // namespace loopbench

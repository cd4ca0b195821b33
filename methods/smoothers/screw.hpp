/// Screw interpolation between keyframes: the geodesic of SE(3).
#pragma once

#include "datasets/core/knot_curve.hpp"
#include "methods/method.hpp"

namespace loopbench::methods {

/// X(t) = X_i Exp(u Log(X_i^-1 X_{i+1})), u = (t - t_i) / (t_{i+1} - t_i). The body twist is
/// constant in every interval, so a circular arc or a helix is exact. Position and rotation are
/// coupled, which suits wheeled vehicles but not handheld sensors. Interpolates the keyframes.
/// Source: Barfoot, State Estimation for Robotics, 7.1.7. O(n) to construct, O(1) amortised per
/// query.
class Screw final : public Smoother {
 public:
  using Options = NoOptions;
  explicit Screw(const Options&) {}

  std::unique_ptr<const Curve> smooth(const Problem& problem, Report&) const override {
    return std::make_unique<ScrewCurve>(problem.keyframes);
  }

 private:
  class ScrewCurve final : public KnotCurve {
   public:
    explicit ScrewCurve(const Trajectory& poses) : KnotCurve(stamps(poses)), poses_(poses) {
      for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
        twists_.push_back(
            log_se3(poses[i].world_from_body.inverse() * poses[i + 1].world_from_body));
      }
    }

   private:
    Pose evaluate(std::size_t i, double time) const override {
      const Pose& before = poses_[i].world_from_body;
      if (time == knots()[i]) return before;  // exact at the knots, without rounding
      if (time == knots()[i + 1]) return poses_[i + 1].world_from_body;
      return normalized(before * exp_se3(fraction(i, time) * twists_[i]));
    }

    Trajectory poses_;
    std::vector<Twist> twists_;  ///< relative motion over each interval
  };
};
}  // namespace loopbench::methods

/// Screw interpolation between keyframes: the geodesic of SE(3).
#pragma once

#include <utility>

#include "datasets/core/interpolate.hpp"
#include "datasets/core/knot_span.hpp"
#include "methods/method.hpp"

namespace loopbench::methods {

/// X(t) = X_i Exp(u Log(X_i^-1 X_{i+1})), u = (t - t_i) / (t_{i+1} - t_i). The body twist is
/// constant in every interval, so a circular arc or a helix is exact. Position and rotation are
/// coupled, which suits wheeled vehicles but not handheld sensors. Interpolates the keyframes.
/// Source: Barfoot, State Estimation for Robotics, 7.1.7. O(n) to construct, O(1) amortised per
/// query.
class Screw final : public Smoother {
 public:
  struct Options {};
  explicit Screw(const Options&) {}

  std::unique_ptr<const Curve> smooth(const Problem& problem, Report&) const override {
    return std::make_unique<ScrewCurve>(problem.keyframes);
  }

 private:
  class ScrewCurve final : public Curve {
   public:
    explicit ScrewCurve(const Trajectory& poses) : poses_(poses), stamps_(stamps(poses)) {
      for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
        twists_.push_back(
            log_se3(poses[i].world_from_body.inverse() * poses[i + 1].world_from_body));
      }
    }

    double start() const override { return stamps_.front(); }
    double end() const override { return stamps_.back(); }

    using Curve::sample;
    void sample(std::span<const double> times, std::span<Pose> poses) const override {
      KnotSpan span(stamps_);
      for (std::size_t k = 0; k < times.size(); ++k) {
        const std::size_t i = span.find(times[k]);
        if (times[k] == stamps_[i]) {  // return nodes without rounding
          poses[k] = poses_[i].world_from_body;
        } else if (times[k] == stamps_[i + 1]) {
          poses[k] = poses_[i + 1].world_from_body;
        } else {
          const double u = (times[k] - stamps_[i]) / (stamps_[i + 1] - stamps_[i]);
          poses[k] = normalized(poses_[i].world_from_body * exp_se3(u * twists_[i]));
        }
      }
    }

   private:
    Trajectory poses_;
    std::vector<double> stamps_;
    std::vector<Twist> twists_;  ///< relative motion over each interval
  };
};

template <class Visit>
void fields(Screw::Options&, Visit) {}

}  // namespace loopbench::methods

/// Composes a corrector and a smoother into one method.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

#include "datasets/core/interpolate.hpp"
#include "datasets/core/knot_span.hpp"
#include "datasets/core/polyline.hpp"
#include "datasets/core/pose_rule.hpp"
#include "methods/method.hpp"

namespace loopbench::methods {

inline void require_same_stamps(const Trajectory& before, const Trajectory& after) {
  if (after.size() != before.size()) {
    throw std::runtime_error("the corrector returned " + std::to_string(after.size()) +
                             " poses, expected " + std::to_string(before.size()) +
                             ", one per keyframe");
  }
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (after[i].stamp == before[i].stamp) continue;
    throw std::runtime_error("the corrector changed the stamp of keyframe " +
                             std::to_string(i + 1) + " from " + to_text(before[i].stamp) + " to " +
                             to_text(after[i].stamp) + " s");
  }
}

/// Returns the problem with its keyframes replaced. Each tracked frame keeps its pose relative to
/// the two keyframes around it, interpolated by time. Edges are copied unchanged. O(keyframes +
/// frames).
inline Problem with_keyframes(const Problem& problem, Trajectory keyframes) {
  const Trajectory& before = problem.keyframes;
  require_same_stamps(before, keyframes);
  // Built field by field, because copying the complete problem would also copy the old keyframes.
  Problem moved{std::move(keyframes),
                problem.odometry,
                problem.closures,
                {},
                problem.planar,
                problem.shared_landmarks,
                problem.anchors};
  moved.frames.reserve(problem.frames.size());
  const std::vector<double> knots = stamps(before);
  KnotSpan span(knots);
  for (const auto& frame : problem.frames) {
    const double stamp = frame.stamp;
    if (knots.size() < 2 || stamp < knots.front() || stamp > knots.back()) continue;
    const std::size_t i = span.find(stamp);
    const auto carried = [&](std::size_t k) {
      return moved.keyframes[k].world_from_body *
             (before[k].world_from_body.inverse() * frame.world_from_body);
    };
    const double u = (stamp - knots[i]) / (knots[i + 1] - knots[i]);
    moved.frames.push_back({stamp, normalized(interpolate(carried(i), carried(i + 1), u))});
  }
  return moved;
}

class Pipeline final : public Estimator {
 public:
  Pipeline(std::unique_ptr<const Corrector> corrector, std::unique_ptr<const Smoother> smoother)
      : corrector_(std::move(corrector)), smoother_(std::move(smoother)) {}

  std::string why_declined(const Problem& problem) const override {
    if (problem.keyframes.empty()) return "no keyframes";
    if (corrector_) {
      if (std::string why = corrector_->why_declined(problem); !why.empty()) return why;
    }
    return smoother_ ? smoother_->why_declined(problem) : "";
  }

  /// A smoother removes no drift, so that it is defined without anchors.
  bool accepts_anchors() const override { return !corrector_ || corrector_->accepts_anchors(); }

  std::unique_ptr<const Curve> estimate(const Problem& problem, Report& report) const override {
    if (!corrector_) return smoothed(problem, report);
    Trajectory keyframes =
        report.time("correct", [&] { return corrector_->correct(problem, report); });
    require_same_stamps(problem.keyframes, keyframes);
    require_valid(keyframes, "corrected keyframe");
    if (!smoother_) return std::make_unique<Polyline>(std::move(keyframes));
    return smoothed(with_keyframes(problem, std::move(keyframes)), report);
  }

  std::unique_ptr<Incremental> incremental(bool planar) const override {
    return corrector_ && !smoother_ ? corrector_->incremental(planar) : nullptr;
  }

 private:
  std::unique_ptr<const Curve> smoothed(const Problem& problem, Report& report) const {
    if (!smoother_) return std::make_unique<Polyline>(problem.keyframes);
    return report.time("smooth", [&] { return smoother_->smooth(problem, report); });
  }

  std::unique_ptr<const Corrector> corrector_;
  std::unique_ptr<const Smoother> smoother_;
};

/// Returns a method that runs `corrector` and then `smoother` on its result. A null corrector means
/// no correction, a null smoother a polyline. `estimate` throws std::runtime_error when the
/// corrector changes the number of keyframes or their stamps.
inline std::unique_ptr<const Estimator> compose(std::unique_ptr<const Corrector> corrector,
                                                std::unique_ptr<const Smoother> smoother) {
  return std::make_unique<Pipeline>(std::move(corrector), std::move(smoother));
}

}  // namespace loopbench::methods

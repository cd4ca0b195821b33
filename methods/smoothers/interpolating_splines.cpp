#include "methods/smoothers/interpolating_splines.hpp"

#include <utility>

#include "datasets/core/polyline.hpp"
#include "methods/smoothers/spline/curve.hpp"

namespace loopbench::methods {
namespace {

/// Combines the positions of one curve with the rotations of another over the same time span.
class PositionAndRotationCurve final : public Curve {
 public:
  PositionAndRotationCurve(std::unique_ptr<const Curve> positions,
                           std::unique_ptr<const Curve> rotations)
      : positions_(std::move(positions)), rotations_(std::move(rotations)) {}

  double start() const override { return positions_->start(); }
  double end() const override { return positions_->end(); }

  using Curve::sample;
  void sample(std::span<const double> times, std::span<Pose> poses) const override {
    rotations_->sample(times, poses);
    std::vector<Pose> translations(times.size());
    positions_->sample(times, translations);
    for (std::size_t k = 0; k < poses.size(); ++k)
      poses[k].translation = translations[k].translation;
  }

 private:
  std::unique_ptr<const Curve> positions_;
  std::unique_ptr<const Curve> rotations_;
};

using SolveControls = std::function<SplineControls(const Trajectory&)>;

std::unique_ptr<const Curve> spline_with(const SplineControls& solved) {
  std::vector<Pose> controls(solved.basis.size());
  for (std::size_t j = 0; j < controls.size(); ++j) {
    controls[j].translation = solved.points[j];
    if (solved.rotations) controls[j].rotation = solved.rotations->controls[j];
  }
  return std::make_unique<CumulativeCurve>(solved.basis, controls);
}

std::unique_ptr<const Curve> spline_through_segment(const Trajectory& keyframes,
                                                    Report& report,
                                                    const SolveControls& solve) {
  if (keyframes.size() < 2) return std::make_unique<Polyline>(keyframes);
  const SplineControls solved = solve(keyframes);
  auto spline = spline_with(solved);
  if (solved.rotations) {
    report.count("iterations", solved.rotations->iterations);
    return spline;
  }
  const auto through_part = [&](const Trajectory& part) -> std::unique_ptr<const Curve> {
    const SplineControls of_part = solve(part);
    return of_part.rotations ? spline_with(of_part) : nullptr;
  };
  return std::make_unique<PositionAndRotationCurve>(
      std::move(spline), interpolate_rotations_in_parts(keyframes, report, through_part));
}

}  // namespace

std::unique_ptr<const Curve> spline_through(const Trajectory& keyframes,
                                            Report& report,
                                            const SolveControls& solve) {
  return smooth_between_short_intervals(
      keyframes, report, [&](const Trajectory& segment, Report& segment_report) {
        return spline_through_segment(segment, segment_report, solve);
      });
}

}  // namespace loopbench::methods

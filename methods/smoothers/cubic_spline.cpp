#include "methods/smoothers/cubic_spline.hpp"

#include <utility>

#include "datasets/core/polyline.hpp"
#include "methods/smoothers/parts.hpp"
#include "methods/smoothers/pose_runs.hpp"
#include "methods/smoothers/position_and_rotation_curve.hpp"
#include "methods/smoothers/spline/curve.hpp"
#include "methods/smoothers/spline/interpolate.hpp"

namespace loopbench::methods {
namespace {

constexpr std::size_t kOrder = 4;

/// Returns the rotation spline through two or more poses, with zero positions, or null if it does
/// not exist.
std::unique_ptr<const Curve> rotation_spline(const Trajectory& keyframes) {
  SplineBasis basis(kOrder, stamps(keyframes));
  const auto solution = natural_rotation_controls(basis, attitudes(keyframes));
  if (!solution) return nullptr;
  std::vector<Pose> controls(basis.size());
  for (std::size_t j = 0; j < controls.size(); ++j) controls[j].rotation = solution->controls[j];
  return std::make_unique<CumulativeCurve>(std::move(basis), controls);
}

}  // namespace

std::string CubicSpline::why_declined(const Problem& problem) const {
  if (problem.keyframes.empty()) return "no keyframes";
  return "";
}

std::unique_ptr<const Curve> CubicSpline::smooth(const Problem& problem, Report& report) const {
  return smooth_between_short_intervals(
      problem.keyframes, report, [&](const Trajectory& keyframes, Report& part_report) {
        return smooth_segment(keyframes, part_report);
      });
}

std::unique_ptr<const Curve> CubicSpline::smooth_segment(const Trajectory& keyframes,
                                                         Report& report) const {
  if (keyframes.size() < 2) return std::make_unique<Polyline>(keyframes);
  const SplineBasis basis(kOrder, stamps(keyframes));
  const std::vector<Vector3> points = natural_controls(basis, positions_of(keyframes));
  std::optional<RotationControls> solution;
  if (options_.rotation == RotationMode::spline) {
    solution = natural_rotation_controls(basis, attitudes(keyframes));
  }
  std::vector<Pose> controls(basis.size());
  for (std::size_t j = 0; j < controls.size(); ++j) {
    controls[j].translation = points[j];
    if (solution) controls[j].rotation = solution->controls[j];
  }
  auto spline = std::make_unique<CumulativeCurve>(basis, controls);
  if (solution) {
    report.count("iterations", solution->iterations);
    return spline;
  }
  if (options_.rotation == RotationMode::slerp) {
    return std::make_unique<PositionAndRotationCurve>(std::move(spline),
                                                      std::make_unique<Polyline>(keyframes));
  }
  return std::make_unique<PositionAndRotationCurve>(
      std::move(spline), interpolate_rotations_in_parts(keyframes, report, rotation_spline));
}

}  // namespace loopbench::methods

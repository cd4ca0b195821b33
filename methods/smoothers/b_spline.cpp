#include "methods/smoothers/b_spline.hpp"

#include "datasets/core/polyline.hpp"
#include "methods/smoothers/parts.hpp"
#include "methods/smoothers/pose_runs.hpp"
#include "methods/smoothers/position_and_rotation_curve.hpp"
#include "methods/smoothers/spline/curve.hpp"
#include "methods/smoothers/spline/interpolate.hpp"

namespace loopbench::methods {

std::string BSplineThrough::why_declined(const Problem& problem) const {
  if (problem.keyframes.empty()) return "no keyframes";
  return "";
}

std::unique_ptr<const Curve> BSplineThrough::smooth(const Problem& problem, Report& report) const {
  return smooth_between_short_intervals(
      problem.keyframes, report, [&](const Trajectory& keyframes, Report& part_report) {
        return smooth_segment(keyframes, part_report);
      });
}

std::unique_ptr<const Curve> BSplineThrough::smooth_segment(const Trajectory& keyframes,
                                                            Report& report) const {
  if (keyframes.size() < 2) return std::make_unique<Polyline>(keyframes);
  const std::vector<double> sites = stamps(keyframes);
  const auto basis = SplineBasis::for_sites(static_cast<std::size_t>(options_.order), sites);
  const std::vector<Vector3> points = interpolating_controls(basis, sites, positions_of(keyframes));
  const auto solution = interpolating_rotation_controls(basis, sites, attitudes(keyframes));
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
  const auto spline_through = [&](const Trajectory& part) -> std::unique_ptr<const Curve> {
    const std::vector<double> part_sites = stamps(part);
    const auto part_basis =
        SplineBasis::for_sites(static_cast<std::size_t>(options_.order), part_sites);
    const auto solved = interpolating_rotation_controls(part_basis, part_sites, attitudes(part));
    if (!solved) return nullptr;
    std::vector<Pose> rotations(part_basis.size());
    for (std::size_t j = 0; j < rotations.size(); ++j) rotations[j].rotation = solved->controls[j];
    return std::make_unique<CumulativeCurve>(part_basis, rotations);
  };
  return std::make_unique<PositionAndRotationCurve>(
      std::move(spline), interpolate_rotations_in_parts(keyframes, report, spline_through));
}

}  // namespace loopbench::methods

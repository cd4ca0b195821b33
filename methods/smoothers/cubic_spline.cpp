#include "methods/smoothers/cubic_spline.hpp"

#include <utility>

#include "datasets/core/interpolate.hpp"
#include "datasets/core/knot_span.hpp"
#include "datasets/core/polyline.hpp"
#include "methods/smoothers/parts.hpp"
#include "methods/smoothers/pose_runs.hpp"
#include "methods/smoothers/position_and_rotation_curve.hpp"
#include "methods/smoothers/spline_controls.hpp"

namespace loopbench::methods {
namespace {

/// Coefficients of one basis function; an interval reads four consecutive ones.
struct Control {
  Vector3 point;                   ///< [m]
  Rotation rotation;               ///< C_j
  Vector3 step = Vector3::Zero();  ///< d_j = Log(C_{j-1}^T C_j) [rad]; unused at j = 0
};

class SplineCurve final : public Curve {
 public:
  SplineCurve(CubicBasis basis, std::vector<Control> controls)
      : basis_(std::move(basis)), controls_(std::move(controls)) {}

  double start() const override { return basis_.stamps().front(); }
  double end() const override { return basis_.stamps().back(); }

  using Curve::sample;
  void sample(std::span<const double> times, std::span<Pose> poses) const override {
    KnotSpan span(basis_.stamps());
    for (std::size_t k = 0; k < times.size(); ++k) {
      const std::size_t i = span.find(times[k]);
      const std::array<double, 4> N = basis_.values(i, times[k]);
      const Control* c = &controls_[i];
      poses[k].translation =
          N[0] * c[0].point + N[1] * c[1].point + N[2] * c[2].point + N[3] * c[3].point;
      poses[k].rotation = (c[0].rotation * exp_so3((N[1] + N[2] + N[3]) * c[1].step) *
                           exp_so3((N[2] + N[3]) * c[2].step) * exp_so3(N[3] * c[3].step))
                              .normalized();
    }
  }

 private:
  CubicBasis basis_;
  std::vector<Control> controls_;
};

void set_rotations(std::vector<Control>& controls, const ControlRotations& solution) {
  for (std::size_t j = 0; j < controls.size(); ++j) {
    controls[j].rotation = solution.rotations[j];
    if (j > 0)
      controls[j].step = log_so3(controls[j - 1].rotation.conjugate() * controls[j].rotation);
  }
}

/// Returns the rotation spline through two or more poses, with zero positions, or null if it does
/// not exist.
std::unique_ptr<const Curve> rotation_spline(const Trajectory& keyframes) {
  CubicBasis basis(stamps(keyframes));
  const auto solution = interpolating_rotations(basis, attitudes(keyframes));
  if (!solution) return nullptr;
  std::vector<Control> controls(basis.size(), Control{Vector3::Zero(), Rotation::Identity()});
  set_rotations(controls, *solution);
  return std::make_unique<SplineCurve>(std::move(basis), std::move(controls));
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
  CubicBasis basis(stamps(keyframes));
  std::vector<Control> controls(basis.size());
  const std::vector<Vector3> points = interpolating_points(basis, positions_of(keyframes));
  for (std::size_t j = 0; j < controls.size(); ++j) controls[j].point = points[j];

  if (options_.rotation == RotationMode::slerp) {
    auto spline = std::make_unique<SplineCurve>(std::move(basis), std::move(controls));
    return std::make_unique<PositionAndRotationCurve>(std::move(spline),
                                                      std::make_unique<Polyline>(keyframes));
  }
  const auto solution = interpolating_rotations(basis, attitudes(keyframes));
  if (solution) {
    report.count("iterations", solution->iterations);
    set_rotations(controls, *solution);
    return std::make_unique<SplineCurve>(std::move(basis), std::move(controls));
  }
  auto spline = std::make_unique<SplineCurve>(std::move(basis), std::move(controls));
  return std::make_unique<PositionAndRotationCurve>(
      std::move(spline), interpolate_rotations_in_parts(keyframes, report, rotation_spline));
}

}  // namespace loopbench::methods

#include "methods/smoothers/smoothing_spline.hpp"

#include <utility>

#include "datasets/core/knot_span.hpp"
#include "datasets/core/polyline.hpp"
#include "methods/smoothers/parts.hpp"
#include "methods/smoothers/penalised/unrolled.hpp"
#include "methods/smoothers/position_and_rotation_curve.hpp"

namespace loopbench::methods {
namespace {

/// Knot of a natural cubic spline: value and second derivative.
struct Knot {
  Vector3 value, bend;
};

std::vector<Knot> knots(const Reinsch::Fit& fit) {
  std::vector<Knot> out;
  out.reserve(fit.values.size());
  for (std::size_t i = 0; i < fit.values.size(); ++i) out.push_back({fit.values[i], fit.bends[i]});
  return out;
}

Vector3 between(const Knot* knot, double u, double interval) {
  const double v = 1.0 - u;
  const double sixth = interval * interval / 6.0;
  return v * knot[0].value + u * knot[1].value -
         sixth * (v * u * ((1.0 + v) * knot[0].bend + (1.0 + u) * knot[1].bend));
}

class PositionSpline final : public Curve {
 public:
  PositionSpline(std::vector<double> stamps, std::vector<Knot> knots)
      : stamps_(std::move(stamps)), knots_(std::move(knots)) {}

  double start() const override { return stamps_.front(); }
  double end() const override { return stamps_.back(); }

  using Curve::sample;
  void sample(std::span<const double> times, std::span<Pose> poses) const override {
    KnotSpan span(stamps_);
    for (std::size_t k = 0; k < times.size(); ++k) {
      const std::size_t i = span.find(times[k]);
      const double interval = stamps_[i + 1] - stamps_[i];
      poses[k] = {Rotation::Identity(),
                  between(&knots_[i], (times[k] - stamps_[i]) / interval, interval)};
    }
  }

 private:
  std::vector<double> stamps_;
  std::vector<Knot> knots_;
};

class RotationSpline final : public Curve {
 public:
  RotationSpline(std::vector<double> stamps, UnrolledRotations path, std::vector<Knot> knots)
      : stamps_(std::move(stamps)), path_(std::move(path)), knots_(std::move(knots)) {}

  double start() const override { return stamps_.front(); }
  double end() const override { return stamps_.back(); }

  using Curve::sample;
  void sample(std::span<const double> times, std::span<Pose> poses) const override {
    KnotSpan span(stamps_);
    for (std::size_t k = 0; k < times.size(); ++k) {
      const std::size_t i = span.find(times[k]);
      const double interval = stamps_[i + 1] - stamps_[i];
      const double u = (times[k] - stamps_[i]) / interval;
      poses[k] = {path_.roll(i, u, between(&knots_[i], u, interval)), Vector3::Zero()};
    }
  }

 private:
  std::vector<double> stamps_;
  UnrolledRotations path_;
  std::vector<Knot> knots_;
};

/// Fits each world axis with its own lambda.
Reinsch::Fit axis_by_axis(const Reinsch& reinsch,
                          const std::vector<double>& stamps,
                          const std::vector<Vector3>& y,
                          Criterion criterion,
                          Report& report) {
  Reinsch::Fit out;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<Vector3> one_axis(y.size(), Vector3::Zero());
    for (std::size_t i = 0; i < y.size(); ++i) one_axis[i][axis] = y[i][axis] - y.front()[axis];
    const double lambda = select_lambda(reinsch, stamps, one_axis, criterion);
    report.count(std::string("lambda_") + "xyz"[axis], lambda);
    const Reinsch::Fit fit = reinsch.fit(one_axis, lambda);
    if (axis == 0) {
      out = fit;
      out.free = 0.0;
      for (Vector3& value : out.values) value += y.front();
    } else {
      for (std::size_t i = 0; i < y.size(); ++i) {
        out.values[i] += fit.values[i];
        out.bends[i] += fit.bends[i];
      }
    }
    out.free += fit.free / 3.0;
  }
  return out;
}

}  // namespace

std::string SmoothingSpline::why_declined(const Problem& problem) const {
  if (problem.keyframes.size() < 3)
    return std::to_string(problem.keyframes.size()) + " keyframes, fewer than 3";
  return "";
}

std::unique_ptr<const Curve> SmoothingSpline::smooth(const Problem& problem, Report& report) const {
  const std::vector<double> times = stamps(problem.keyframes);
  const auto size = static_cast<double>(times.size());
  const Reinsch reinsch(times);

  Reinsch::Fit positions;
  const std::vector<Vector3> points = positions_of(problem.keyframes);
  if (options_.axes == Axes::each && !options_.lambda_t) {
    positions = axis_by_axis(reinsch, times, points, options_.criterion, report);
  } else {
    const double lambda = options_.lambda_t.value_or(0.0) > 0.0
                              ? *options_.lambda_t
                              : select_lambda(reinsch, times, points, options_.criterion);
    report.count("lambda_t", lambda);
    positions = reinsch.fit(points, lambda);
  }
  report.count("dof_t", size - positions.free);
  auto position_curve = std::make_unique<PositionSpline>(times, knots(positions));
  if (options_.rotation == RotationMode::slerp) {
    return std::make_unique<PositionAndRotationCurve>(
        std::move(position_curve), std::make_unique<Polyline>(problem.keyframes));
  }

  // The first rounds change the unrolled data; after kChoices rounds lambda is kept.
  double lambda = options_.lambda_r.value_or(0.0);
  int rounds = 0;
  const auto rotation =
      smoothed_rotations(attitudes(problem.keyframes), [&](const std::vector<Vector3>& flat) {
        constexpr int kChoices = 3;
        if (!options_.lambda_r && rounds++ < kChoices) {
          lambda = select_lambda(reinsch, times, flat, options_.criterion);
        }
        return reinsch.fit(flat, lambda);
      });
  report.count("lambda_r", lambda);
  report.count("dof_r", size - rotation.fit.free);
  report.count("iterations", rotation.iterations);
  if (!rotation.converged) report.notes.push_back("the rotation fit did not converge");
  return std::make_unique<PositionAndRotationCurve>(
      std::move(position_curve),
      std::make_unique<RotationSpline>(times, rotation.path, knots(rotation.fit)));
}

}  // namespace loopbench::methods

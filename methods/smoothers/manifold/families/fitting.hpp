/// Extent of a window's points and Levenberg-Marquardt for few parameters and nodes, for the fits
/// of the curve families.
///
/// A window has 3 to 12 residuals and 3 to 10 parameters. This solver keeps everything on the
/// stack; setting up a general solver would take longer than the solution.
#pragma once

#include <Eigen/Cholesky>
#include <algorithm>
#include <span>

#include "methods/smoothers/manifold/families/frame.hpp"

namespace loopbench::methods::manifold {

constexpr int kMaxNodes = 12;  ///< per window
constexpr int kMaxParameters = 10;

using Parameters = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxParameters, 1>;
using FamilyResiduals = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxNodes, 1>;
using Slopes = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxNodes, kMaxParameters>;

/// Minimises the sum of squares. `evaluate(parameters, residuals, slopes)` sets both outputs, with
/// slopes = d residual / d parameter. Marquardt scaling of the damping; a step is accepted only if
/// it lowers the sum of squares, so the result is never worse than `start`. Stops after
/// 50 iterations or at a relative decrease below 1e-14.
template <class Evaluate>
Parameters levenberg_marquardt(Parameters start, Eigen::Index count, Evaluate evaluate) {
  constexpr int kMostIterations = 50;
  FamilyResiduals r(count), trial_residuals(count);
  Slopes J(count, start.size()), slopes(count, start.size());
  evaluate(start, r, J);
  double cost = r.squaredNorm();
  double damping = 1e-3;
  for (int i = 0; i < kMostIterations && damping < 1e12 && cost > 0.0; ++i) {
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxParameters, kMaxParameters> H =
        J.transpose() * J;
    const double floor = 1e-15 * std::max(H.diagonal().maxCoeff(), 1e-300);
    H.diagonal().array() += damping * H.diagonal().array().max(floor);
    const Parameters next = start - H.ldlt().solve(J.transpose() * r);
    evaluate(next, trial_residuals, slopes);
    const double trial_cost = trial_residuals.squaredNorm();
    if (!(trial_cost < cost)) {
      damping *= 8.0;
      continue;
    }
    const bool converged = cost - trial_cost < 1e-14 * cost;
    start = next;
    r = trial_residuals;
    J = slopes;
    cost = trial_cost;
    damping = std::max(damping * 0.2, 1e-12);
    if (converged) break;
  }
  return start;
}

/// Bounding box of points, for centring and scaling their coordinates.
struct Extent {
  Vector2 low, high;  ///< [m]

  explicit Extent(std::span<const Vector2> points) : low(points.front()), high(points.front()) {
    for (const Vector2& point : points) {
      low = low.cwiseMin(point);
      high = high.cwiseMax(point);
    }
  }
  Vector2 centre() const { return 0.5 * (low + high); }
  Vector2 size() const { return high - low; }
};

// Joints evaluate a curve up to one node past its window, which is half of the range for the
// shortest window, so poles must be at least that far away.
constexpr double kPoleMargin = 0.5;  // fraction of the range of x

}  // namespace loopbench::methods::manifold

/// Levenberg-Marquardt for a handful of parameters and nodes: the nonlinear families' solver.
///
/// Our own because a window has 3 to 12 residuals and 3 to 10 parameters: everything stays on the
/// stack, and building a general solver's problem would cost more than solving it.
#pragma once

#include <Eigen/Cholesky>
#include <algorithm>

namespace loopbench::manifold {

constexpr int kMostNodes = 12;  ///< in one window
constexpr int kMostParameters = 10;

using Parameters = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostParameters, 1>;
using Residuals = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostNodes, 1>;
using Slopes =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostNodes, kMostParameters>;

/// `evaluate(parameters, residuals, slopes)` fills both (slopes = d residual / d parameter).
/// Damping by Marquardt's scaling; a step is taken only if it lowers the sum of squares, so the
/// result is never worse than `start`. Stops at `iterations` or a relative gain below 1e-14.
template <class Evaluate>
Parameters levenberg_marquardt(Parameters start,
                               Eigen::Index count,
                               Evaluate evaluate,
                               int iterations = 50) {
  Residuals r(count), tried(count);
  Slopes J(count, start.size()), slopes(count, start.size());
  evaluate(start, r, J);
  double cost = r.squaredNorm();
  double damping = 1e-3;
  for (int i = 0; i < iterations && damping < 1e12 && cost > 0.0; ++i) {
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostParameters, kMostParameters> H =
        J.transpose() * J;
    const double floor = 1e-15 * std::max(H.diagonal().maxCoeff(), 1e-300);
    H.diagonal().array() += damping * H.diagonal().array().max(floor);
    const Parameters next = start - H.ldlt().solve(J.transpose() * r);
    evaluate(next, tried, slopes);
    const double trial = tried.squaredNorm();
    if (!(trial < cost)) {
      damping *= 8.0;
      continue;
    }
    const bool settled = cost - trial < 1e-14 * cost;
    start = next;
    r = tried;
    J = slopes;
    cost = trial;
    damping = std::max(damping * 0.2, 1e-12);
    if (settled) break;
  }
  return start;
}

}  // namespace loopbench::manifold

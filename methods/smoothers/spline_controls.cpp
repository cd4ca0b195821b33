#include "methods/smoothers/spline_controls.hpp"

#include <algorithm>

#include "datasets/core/interpolate.hpp"
#include "datasets/core/tridiagonal.hpp"

namespace loopbench::methods {
namespace {

/// Residual below which Newton has converged [rad]; rounding is about 1e-15.
constexpr double kCubicTolerance = 1e-13;
/// Largest accepted residual when rounding stops Newton above kCubicTolerance [rad].
constexpr double kCubicGoodEnough = 1e-11;
constexpr int kCubicSteps = 30;
constexpr int kCubicHalvings = 12;

using Row = TridiagonalRow<Matrix3, Vector3>;

/// Values of the three basis functions that are nonzero at stamp i: N_i, N_{i+1}, N_{i+2}.
std::array<double, 4> values_at_stamp(const CubicBasis& basis, std::size_t i) {
  return basis.values(i, basis.stamps()[i]);
}

/// A Exp(share * Log(A^T B)) and its derivative with respect to B in the world frame: perturbing A
/// and B by Exp(a), Exp(b) on the left rotates the result by a + M (b - a).
struct Arc {
  Rotation rotation;
  Matrix3 M;
};

Arc arc(const Rotation& frame, const Rotation& a, const Rotation& b, double share) {
  const Vector3 step = log_so3(a.conjugate() * b);
  const Matrix3 K = share * left_jacobian_so3(share * step) * inverse_left_jacobian_so3(step);
  return {frame * exp_so3(share * step),
          frame.toRotationMatrix() * K * a.conjugate().toRotationMatrix()};
}

/// One row per unknown control C_1..C_n; `right` is the residual as a rotation vector in the world
/// frame.
std::vector<Row> linearise(const CubicBasis& basis,
                           const std::vector<Rotation>& controls,
                           const std::vector<Rotation>& rotations) {
  const std::size_t n = rotations.size();
  std::vector<Row> rows(n);
  const Matrix3 I = Matrix3::Identity();
  const auto add_natural_end =
      [&](Row& row, Matrix3 Row::*side, std::size_t outer, int inward, double u) {
        const auto at = [&](int steps) {
          return controls[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(outer) +
                                                   steps * inward)];
        };
        const Rotation end = at(0);
        const Arc target = arc(end, end, at(2), u);
        row = {Matrix3::Zero(), I, Matrix3::Zero(), log_so3(target.rotation * at(1).conjugate())};
        // With two keyframes the inner control is the other unknown.
        row.*side = -target.M;
      };
  add_natural_end(rows.front(), &Row::upper, 0, 1, basis.natural_fraction_at_start());
  add_natural_end(rows.back(), &Row::lower, n + 1, -1, basis.natural_fraction_at_end());
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const std::array<double, 4> N = values_at_stamp(basis, i);
    const Arc first = arc(controls[i], controls[i], controls[i + 1], N[1] + N[2]);
    const Arc second = arc(first.rotation, controls[i + 1], controls[i + 2], N[2]);
    rows[i] = {I - first.M,
               first.M - second.M,
               second.M,
               log_so3(rotations[i] * second.rotation.conjugate())};
  }
  return rows;
}

double largest_residual(const std::vector<Row>& rows) {
  double out = 0.0;
  for (const Row& row : rows) out = std::max(out, row.right.norm());
  return out;
}

/// Initial controls: on the great arcs through the rotations at the Greville abscissae, which is
/// exact for a constant angular velocity.
std::vector<Rotation> initial_controls(const CubicBasis& basis,
                                       const std::vector<Rotation>& rotations) {
  const std::vector<double>& stamps = basis.stamps();
  std::vector<Rotation> out(basis.size());
  for (std::size_t j = 1; j + 1 < out.size(); ++j) {
    const double time = basis.greville(j);
    // The time lies between the stamps j - 2 and j, at most one interval from stamp j - 1.
    std::size_t i = std::min(j - 1, stamps.size() - 2);
    if (i > 0 && time < stamps[i]) --i;
    const double u = (time - stamps[i]) / (stamps[i + 1] - stamps[i]);
    out[j] = slerp(rotations[i], rotations[i + 1], u);
  }
  out.front() = rotations.front();
  out.back() = rotations.back();
  return out;
}

}  // namespace

std::vector<Vector3> interpolating_points(const CubicBasis& basis,
                                          const std::vector<Vector3>& points) {
  const std::size_t n = points.size();
  const double a = basis.natural_fraction_at_start();
  const double b = basis.natural_fraction_at_end();
  std::vector<TridiagonalRow<double, Vector3>> rows(n);  // unknowns c_1..c_n
  rows.front() = {0.0, 1.0, -a, (1.0 - a) * points.front()};
  rows.back() = {-b, 1.0, 0.0, (1.0 - b) * points.back()};
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const std::array<double, 4> N = values_at_stamp(basis, i);
    rows[i] = {N[0], N[1], N[2], points[i]};
  }
  std::vector<Vector3> out = solve_tridiagonal(rows);
  out.insert(out.begin(), points.front());
  out.push_back(points.back());
  return out;
}

std::optional<ControlRotations> interpolating_rotations(const CubicBasis& basis,
                                                        const std::vector<Rotation>& rotations) {
  ControlRotations out{initial_controls(basis, rotations), 0};
  std::vector<Row> rows = linearise(basis, out.rotations, rotations);
  double residual = largest_residual(rows);
  for (; residual > kCubicTolerance && out.iterations < kCubicSteps; ++out.iterations) {
    const std::vector<Vector3> step = solve_tridiagonal(rows);
    bool better = false;
    double share = 1.0;
    for (int halving = 0; halving <= kCubicHalvings && !better; ++halving, share *= 0.5) {
      std::vector<Rotation> trial = out.rotations;
      for (std::size_t i = 0; i < step.size(); ++i) {
        trial[i + 1] = (exp_so3(share * step[i]) * trial[i + 1]).normalized();
      }
      rows = linearise(basis, trial, rotations);
      const double trial_residual = largest_residual(rows);
      better = trial_residual < residual;  // false for NaN as well
      if (!better) continue;
      residual = trial_residual;
      out.rotations = std::move(trial);
    }
    if (!better) break;
  }
  if (residual > kCubicGoodEnough) return std::nullopt;
  return out;
}

}  // namespace loopbench::methods

#include "methods/smoothers/spline/interpolate.hpp"

#include <utility>

#include "datasets/core/interpolate.hpp"
#include "datasets/core/knot_span.hpp"
#include "methods/smoothers/spline/block_banded.hpp"
#include "methods/smoothers/spline/rotation_derivative.hpp"

namespace loopbench::methods {
namespace {

/// Residual below which Newton has converged [rad]; rounding is about 1e-15.
constexpr double kTolerance = 1e-13;
/// Largest accepted residual when rounding stops Newton above kTolerance [rad].
constexpr double kAccepted = 1e-11;
constexpr int kMostSteps = 30;
constexpr int kMostHalvings = 12;

using System = BlockBanded<Matrix3, Vector3>;

/// The linearised system and the largest residual of the curve.
struct Linearised {
  System system;
  double residual = 0.0;
};

Linearised linearise(const SplineBasis& basis,
                     const std::vector<double>& sites,
                     const std::vector<Rotation>& controls,
                     const std::vector<Rotation>& rotations) {
  const std::size_t k = basis.order();
  Linearised out{System(sites.size(), k - 1, Matrix3::Zero(), Vector3::Zero())};
  KnotSpan span(basis.breaks());
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const std::size_t piece = span.find(sites[i]);
    const RotationDerivative evaluated =
        rotation_derivative(&controls[piece], k, basis.cumulative(piece, sites[i]));
    for (std::size_t j = 0; j < k; ++j) {
      // At a site on a knot one function is zero, and its column may lie outside the band.
      const std::size_t column = piece + j;
      if (column + k > i && column < i + k) out.system.at(i, column) = evaluated.by[j];
    }
    out.system.right(i) = log_so3(rotations[i] * evaluated.rotation.conjugate());
    out.residual = std::max(out.residual, out.system.right(i).norm());
  }
  return out;
}

/// Initial controls: on the great arcs through the rotations at the Greville abscissae, which is
/// exact for a constant angular velocity.
std::vector<Rotation> initial_controls(const SplineBasis& basis,
                                       const std::vector<double>& sites,
                                       const std::vector<Rotation>& rotations) {
  std::vector<Rotation> out(basis.size());
  KnotSpan span(sites);
  for (std::size_t j = 1; j + 1 < out.size(); ++j) {
    const double time = basis.greville(j);
    const std::size_t i = span.find(time);
    const double u = (time - sites[i]) / (sites[i + 1] - sites[i]);
    out[j] = slerp(rotations[i], rotations[i + 1], u);
  }
  out.front() = rotations.front();
  out.back() = rotations.back();
  return out;
}

}  // namespace

std::vector<Vector3> interpolating_controls(const SplineBasis& basis,
                                            const std::vector<double>& sites,
                                            const std::vector<Vector3>& points) {
  const std::size_t k = basis.order();
  BlockBanded<double, Vector3> system(sites.size(), k - 1, 0.0, Vector3::Zero());
  KnotSpan span(basis.breaks());
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const std::size_t piece = span.find(sites[i]);
    const SplineBasis::Values N = basis.values(piece, sites[i]);
    for (std::size_t j = 0; j < k; ++j) {
      const std::size_t column = piece + j;
      if (column + k > i && column < i + k) system.at(i, column) = N[j];
    }
    system.right(i) = points[i] - points.front();
  }
  std::vector<Vector3> out = system.solve();
  for (Vector3& point : out) point += points.front();
  return out;
}

std::optional<RotationControls> interpolating_rotation_controls(
    const SplineBasis& basis,
    const std::vector<double>& sites,
    const std::vector<Rotation>& rotations) {
  RotationControls out{initial_controls(basis, sites, rotations), 0};
  Linearised current = linearise(basis, sites, out.controls, rotations);
  for (; current.residual > kTolerance && out.iterations < kMostSteps; ++out.iterations) {
    const std::vector<Vector3> step = current.system.solve();
    bool better = false;
    double share = 1.0;
    for (int halving = 0; halving <= kMostHalvings && !better; ++halving, share *= 0.5) {
      std::vector<Rotation> trial = out.controls;
      for (std::size_t j = 0; j < step.size(); ++j) {
        trial[j] = (exp_so3(share * step[j]) * trial[j]).normalized();
      }
      Linearised next = linearise(basis, sites, trial, rotations);
      better = next.residual < current.residual;  // false for NaN as well
      if (!better) continue;
      current = std::move(next);
      out.controls = std::move(trial);
    }
    if (!better) break;
  }
  if (!(current.residual <= kAccepted)) return std::nullopt;
  return out;
}

}  // namespace loopbench::methods

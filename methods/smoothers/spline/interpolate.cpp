#include "methods/smoothers/spline/interpolate.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "datasets/core/interpolate.hpp"
#include "datasets/core/knot_span.hpp"
#include "methods/smoothers/spline/curve.hpp"

namespace loopbench::methods {
namespace {

/// Residual below which Newton has converged [rad]; rounding is about 1e-15.
constexpr double kTolerance = 1e-13;
/// Largest accepted residual when rounding stops Newton above kTolerance [rad].
constexpr double kAccepted = 1e-11;
constexpr int kMostSteps = 30;
constexpr int kMostHalvings = 12;

/// The linearised system in the rotation vectors of the unknown controls, and the largest residual.
struct Linearised {
  BandedSystem<Matrix3, Vector3> system;
  double residual = 0.0;

  void set_residual(std::size_t row, const Rotation& wanted, const Rotation& found) {
    system.right(row) = log_so3(wanted * found.conjugate());
    residual = std::max(residual, system.right(row).norm());
  }
};

Linearised linearise(const SplineBasis& basis,
                     const std::vector<double>& sites,
                     const std::vector<Rotation>& controls,
                     const std::vector<Rotation>& rotations) {
  const std::size_t k = basis.order();
  Linearised out{{sites.size(), k - 1}};
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
    out.set_residual(i, rotations[i], evaluated.rotation);
  }
  return out;
}

/// Natural ends of a cubic: the second control lies on the line (great arc) from the outer to the
/// third one, at this fraction of its length.
struct NaturalFractions {
  double start, end;

  explicit NaturalFractions(const SplineBasis& basis) {
    const std::size_t last = basis.size() - 1;
    const auto fraction = [&](std::size_t outer, std::size_t second, std::size_t third) {
      return (basis.greville(second) - basis.greville(outer)) /
             (basis.greville(third) - basis.greville(outer));
    };
    start = fraction(0, 1, 2);
    end = fraction(last, last - 1, last - 2);
  }
};

/// One row per unknown control C_1..C_n; C_0 and C_{n+1} are the first and last rotation.
Linearised linearise_natural(const SplineBasis& basis,
                             const std::vector<Rotation>& controls,
                             const std::vector<Rotation>& rotations) {
  const std::size_t n = rotations.size();
  Linearised out{{n, 1}};
  const auto set_end = [&](std::size_t outer, std::size_t second, std::size_t third, double u) {
    const std::array arc{controls[outer], controls[third]};
    const RotationDerivative target = rotation_derivative(arc.data(), 2, {1.0, u});
    out.system.at(second - 1, second - 1) = Matrix3::Identity();
    // With two keyframes the third control is the other unknown.
    out.system.at(second - 1, third - 1) = -target.by[1];
    out.set_residual(second - 1, target.rotation, controls[second]);
  };
  const NaturalFractions u(basis);
  set_end(0, 1, 2, u.start);
  set_end(n + 1, n, n - 1, u.end);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    // The fourth function is zero at the stamp.
    const RotationDerivative evaluated =
        rotation_derivative(&controls[i], 3, basis.cumulative(i, basis.breaks()[i]));
    for (std::size_t j = 0; j < 3; ++j) out.system.at(i, i + j - 1) = evaluated.by[j];
    out.set_residual(i, rotations[i], evaluated.rotation);
  }
  return out;
}

/// Newton's method on the world-frame rotation vectors of the controls from `first_unknown` on.
template <class Linearise>
std::optional<RotationControls> solve_by_newton(std::vector<Rotation> controls,
                                                std::size_t first_unknown,
                                                Linearise linearise_at) {
  RotationControls out{std::move(controls), 0};
  Linearised current = linearise_at(out.controls);
  for (; current.residual > kTolerance && out.iterations < kMostSteps; ++out.iterations) {
    const std::vector<Vector3> step = current.system.solve();
    bool better = false;
    double share = 1.0;
    for (int halving = 0; halving <= kMostHalvings && !better; ++halving, share *= 0.5) {
      std::vector<Rotation> trial = out.controls;
      for (std::size_t j = 0; j < step.size(); ++j) {
        Rotation& control = trial[first_unknown + j];
        control = (exp_so3(share * step[j]) * control).normalized();
      }
      Linearised next = linearise_at(trial);
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

std::vector<Vector3> natural_controls(const SplineBasis& basis,
                                      const std::vector<Vector3>& points) {
  const std::size_t n = points.size();
  BandedSystem<double, Vector3> system(n, 1);  // unknowns c_1..c_n
  const NaturalFractions u(basis);
  system.at(0, 0) = 1.0;
  system.at(0, 1) = -u.start;
  system.right(0) = (1.0 - u.start) * points.front();
  system.at(n - 1, n - 2) = -u.end;
  system.at(n - 1, n - 1) = 1.0;
  system.right(n - 1) = (1.0 - u.end) * points.back();
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const SplineBasis::Values N = basis.values(i, basis.breaks()[i]);
    for (std::size_t j = 0; j < 3; ++j) system.at(i, i + j - 1) = N[j];
    system.right(i) = points[i];
  }
  std::vector<Vector3> out = system.solve();
  out.insert(out.begin(), points.front());
  out.push_back(points.back());
  return out;
}

std::optional<RotationControls> interpolating_rotation_controls(
    const SplineBasis& basis,
    const std::vector<double>& sites,
    const std::vector<Rotation>& rotations) {
  return solve_by_newton(
      initial_controls(basis, sites, rotations), 0, [&](const std::vector<Rotation>& controls) {
        return linearise(basis, sites, controls, rotations);
      });
}

std::optional<RotationControls> natural_rotation_controls(const SplineBasis& basis,
                                                          const std::vector<Rotation>& rotations) {
  return solve_by_newton(initial_controls(basis, basis.breaks(), rotations),
                         1,
                         [&](const std::vector<Rotation>& controls) {
                           return linearise_natural(basis, controls, rotations);
                         });
}

}  // namespace loopbench::methods

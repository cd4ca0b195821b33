/// Controls of splines of order k that interpolate given values.
#pragma once

#include <optional>
#include <vector>

#include "datasets/core/banded.hpp"
#include "methods/smoothers/spline/basis.hpp"

namespace loopbench::methods {

/// Solves sum_j N_j(sites[i]) c_j = points[i]; `basis` is SplineBasis::for_sites. O(n k^2).
template <class Value>
std::vector<Value> interpolating_controls(const SplineBasis& basis,
                                          const std::vector<double>& sites,
                                          const std::vector<Value>& points) {
  const std::size_t k = basis.order();
  BandedSystem<double, Value> system(sites.size(), k - 1);
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const std::size_t piece = basis.piece_at(sites[i]);
    const SplineBasis::Values N = basis.values(piece, sites[i]);
    for (std::size_t j = 0; j < k; ++j) {
      // At a site on a knot one function is zero, and its column may lie outside the band.
      const std::size_t column = piece + j;
      if (column + k > i && column < i + k) system.at(i, column) = N[j];
    }
    system.right(i) = points[i] - points.front();
  }
  std::vector<Value> out = system.solve();
  for (Value& point : out) point += points.front();
  return out;
}

/// Returns the n + 2 control points of the natural cubic spline through n >= 2 points at the breaks
/// of a basis of order 4. O(n).
std::vector<Vector3> natural_controls(const SplineBasis& basis, const std::vector<Vector3>& points);

struct RotationControls {
  std::vector<Rotation> controls;
  int iterations = 0;  ///< number of Newton steps
};

/// Returns the control rotations of the cumulative spline through `rotations`. Newton's method on
/// world-frame rotation vectors: 3 x 3 blocks, k - 1 diagonals on each side, O(n k^2) per step,
/// quadratic convergence. A step that does not reduce the largest residual is halved. Returns
/// nullopt when no such spline is found: consecutive controls must be less than pi apart.
std::optional<RotationControls> interpolating_rotation_controls(
    const SplineBasis& basis,
    const std::vector<double>& sites,
    const std::vector<Rotation>& rotations);

/// The same for the n + 2 controls of the natural cubic spline: through n >= 2 rotations at the
/// breaks of a basis of order 4, with zero angular acceleration at both ends. With end knots
/// repeated four times this end condition is: C_1 lies on the great arc from C_0 to C_2, and
/// likewise at the other end. The system is block tridiagonal.
std::optional<RotationControls> natural_rotation_controls(const SplineBasis& basis,
                                                          const std::vector<Rotation>& rotations);

}  // namespace loopbench::methods

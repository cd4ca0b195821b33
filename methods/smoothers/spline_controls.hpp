/// Control points and control rotations of the cubic splines that pass through given values.
#pragma once

#include <optional>
#include <vector>

#include "datasets/core/so3.hpp"
#include "methods/smoothers/cubic_basis.hpp"

namespace loopbench {

/// The n + 2 control points of the natural cubic spline through n points, one at each stamp of
/// the basis. O(n).
std::vector<Vector3> interpolating_points(const CubicBasis& basis,
                                          const std::vector<Vector3>& points);

struct ControlRotations {
  std::vector<Rotation> rotations;  ///< n + 2
  int iterations = 0;               ///< Newton steps taken
};

/// The n + 2 control rotations C_j of the cumulative spline
///
///     R(t) = C_0 prod_{j=1}^{n+1} Exp(B_j(t) d_j),  d_j = Log(C_{j-1}^T C_j),
///     B_j = N_j + N_{j+1} + ...
///
/// that passes through n rotations, with zero angular acceleration at both ends. With fourfold end
/// knots that end condition reads exactly: C_1 lies on the great arc from C_0 to C_2, likewise at
/// the end, so it costs one more row each of the same kind.
///
/// Newton's method on the world-frame rotation vectors of C_1..C_n: the Jacobian is block
/// tridiagonal, O(n) a step, and convergence is quadratic (3 to 6 steps). A step that does not
/// lessen the largest residual is halved.
///
/// Nothing is returned when no such spline was found: consecutive controls must stay less than pi
/// apart, which fails when keyframes turn by nearly half a turn against each other.
///
/// Source: Kim, Kim & Shin 1995 (cumulative form); Sommer et al., CVPR 2020 (derivatives).
std::optional<ControlRotations> interpolating_rotations(const CubicBasis& basis,
                                                        const std::vector<Rotation>& rotations);

}  // namespace loopbench

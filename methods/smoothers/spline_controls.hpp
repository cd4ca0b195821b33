/// Control points and control rotations of cubic splines that interpolate given values.
#pragma once

#include <optional>
#include <vector>

#include "datasets/core/so3.hpp"
#include "methods/smoothers/cubic_basis.hpp"

namespace loopbench::methods {

/// Returns the n + 2 control points of the natural cubic spline through n points, one per stamp of
/// the basis. O(n).
std::vector<Vector3> interpolating_points(const CubicBasis& basis,
                                          const std::vector<Vector3>& points);

struct ControlRotations {
  std::vector<Rotation> rotations;  ///< n + 2
  int iterations = 0;               ///< number of Newton steps
};

/// Returns the n + 2 control rotations C_j of the cumulative spline
///
///     R(t) = C_0 prod_{j=1}^{n+1} Exp(B_j(t) d_j),  d_j = Log(C_{j-1}^T C_j),
///     B_j = N_j + N_{j+1} + ...
///
/// that interpolates n rotations and has zero angular acceleration at both ends. With end knots
/// repeated four times this end condition is: C_1 lies on the great arc from C_0 to C_2, and
/// likewise at the other end. It adds one row of the same form per end.
///
/// Newton's method on the world-frame rotation vectors of C_1..C_n. The Jacobian is block
/// tridiagonal, a step is O(n), and convergence is quadratic (3 to 6 steps). A step that does not
/// reduce the largest residual is halved.
///
/// Returns nullopt when no such spline is found: consecutive controls must be less than pi apart,
/// which fails when consecutive keyframes differ by almost pi.
///
/// Source: Kim, Kim & Shin 1995 (cumulative form); Sommer et al., CVPR 2020 (derivatives).
std::optional<ControlRotations> interpolating_rotations(const CubicBasis& basis,
                                                        const std::vector<Rotation>& rotations);

}  // namespace loopbench::methods

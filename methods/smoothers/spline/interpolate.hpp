/// Controls of the splines of order k that pass through given values.
#pragma once

#include <optional>
#include <vector>

#include "datasets/core/so3.hpp"
#include "methods/smoothers/spline/basis.hpp"

namespace loopbench {

/// sum_j N_j(sites[i]) c_j = points[i]; `basis` is SplineBasis::for_sites. O(n k^2).
std::vector<Vector3> points_through(const SplineBasis& basis,
                                    const std::vector<double>& sites,
                                    const std::vector<Vector3>& points);

struct RotationsThrough {
  std::vector<Rotation> controls;
  int iterations = 0;  ///< Newton steps taken
};

/// Control rotations of the cumulative spline through `rotations`. Newton's method on world-frame
/// rotation vectors: blocks of 3 x 3, k - 1 diagonals on each side, O(n k^2) a step, quadratic
/// convergence; a step that does not lessen the largest miss is halved. Nothing when no such spline
/// was found: consecutive controls must stay less than pi apart.
std::optional<RotationsThrough> rotations_through(const SplineBasis& basis,
                                                  const std::vector<double>& sites,
                                                  const std::vector<Rotation>& rotations);

}  // namespace loopbench

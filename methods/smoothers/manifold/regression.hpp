/// Joints by constrained least squares: cubics on windows with equal value, slope and second
/// derivative at their joints form one cubic spline, which is fitted directly.
#pragma once

#include <span>

#include "methods/smoothers/manifold/planar.hpp"

namespace loopbench::methods::manifold {

/// Least-squares fit of r(s) in space over the arc length along all nodes, with knots where
/// consecutive windows of N nodes meet. Equal to the windows' cubics under equality constraints,
/// without multipliers. For the parametric frame only: with y' = f(x') every window has its own
/// axes, so C2 continuity is not a linear condition. One piece owns all edges. Returns nullopt when
/// the path has zero length. O(nodes).
std::optional<PlanarFit> fit_regression(const Nodes& nodes,
                                        std::span<const NodeRange> segments,
                                        const NodeSpline& spline,
                                        std::size_t N);

}  // namespace loopbench::methods::manifold

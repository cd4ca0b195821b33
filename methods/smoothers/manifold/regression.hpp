/// Joints by constrained least squares: cubics on windows with equal value, slope and second
/// derivative where they meet are one cubic spline, so that is what is fitted.
#pragma once

#include <span>

#include "methods/smoothers/manifold/planar.hpp"

namespace loopbench::manifold {

/// r(s) over the way along all nodes, least squares in space, knots where consecutive windows of N
/// nodes meet. The same function as the windows' cubics under equality constraints, without their
/// multipliers. Only for the parametric frame: in y' = f(x') every window has axes of its own, in
/// which C2 is no linear condition. One piece owns everything. Nothing when the nodes have no way.
/// O(nodes).
std::optional<PlanarFit> fit_regression(const Nodes& nodes,
                                        std::span<const NodeRange> segments,
                                        const NodeSpline& spline,
                                        std::size_t N);

}  // namespace loopbench::manifold

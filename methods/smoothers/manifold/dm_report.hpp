/// Adds the results of the manifold smoother's steps to a report.
#pragma once

#include "methods/report.hpp"
#include "methods/smoothers/manifold/curve.hpp"
#include "methods/smoothers/manifold/planar.hpp"
#include "methods/smoothers/manifold/quasi_keyframes.hpp"

namespace loopbench::methods::manifold {

void count(Report& report, const char* name, std::size_t value);

void describe(const NodesWithQuasiKeyframes& dense, Report& report);
/// Add counts, and sections: the segments, the planar windows with their families, the spatial
/// windows.
void describe(const Nodes& nodes, std::span<const NodeRange> segments, Report& report);
void describe(const Nodes& nodes, const PlanarFit& fit, Report& report);
void describe(const Nodes& nodes, const SpatialFit& fit, Report& report);

/// Adds the largest jumps of position, velocity, acceleration, tangent and curvature over all inner
/// nodes. Nodes where the speed on either side is below 1/1000 of the mean speed are ignored for
/// tangent and curvature, because the direction is undefined there. A B-spline of order 3 has its
/// acceleration jumps between nodes. O(nodes).
void describe_jumps(const ManifoldCurve& curve, Report& report);

}  // namespace loopbench::methods::manifold

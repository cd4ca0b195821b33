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
/// nodes.
void describe_jumps(const ManifoldCurve& curve, Report& report);

}  // namespace loopbench::methods::manifold

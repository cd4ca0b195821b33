/// What the manifold smoother tells of its steps.
#pragma once

#include "methods/report.hpp"
#include "methods/smoothers/manifold/continuity.hpp"
#include "methods/smoothers/manifold/moving_frames.hpp"
#include "methods/smoothers/manifold/planar.hpp"
#include "methods/smoothers/manifold/quasi_keyframes.hpp"

namespace loopbench::manifold {

void count(Report& report, const char* name, std::size_t value);

void describe(const Densified& dense, Report& report);
void describe(const PlanarFit& fit, Report& report);
void describe(const SpatialFit& fit, Report& report);
/// Sections: the segments, the windows with their families, the surfaces of the windows in space.
void describe(const Nodes& nodes, std::span<const NodeRange> segments, Report& report);
void describe(const Nodes& nodes, const PlanarFit& fit, Report& report);
void describe(const Nodes& nodes, const SpatialFit& fit, Report& report);

void describe(const Continuity& jumps, Report& report);
void describe(const MovingFrames& frames, Report& report);

/// A note a window: its nodes, its family and the coefficients.
void note_coefficients(const PlanarFit& fit, Report& report);
void note_coefficients(const SpatialFit& fit, double base_height, Report& report);

}  // namespace loopbench::manifold

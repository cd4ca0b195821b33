/// Projection of a trajectory onto a coordinate plane, as evo's --project_to_plane.
#pragma once

#include "datasets/core/trajectory.hpp"
#include "metrics/protocols/protocol.hpp"

namespace loopbench::metrics {

/// Sets the coordinate normal to the plane to zero and keeps of each orientation only its Euler
/// angle about the normal (euler.hpp; for xz that is the pitch, limited to +-90 degrees). evo
/// core/trajectory.py:200-230. O(n). No effect for `none`.
void project(Trajectory& trajectory, ProjectionPlane plane);

}  // namespace loopbench::metrics

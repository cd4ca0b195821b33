/// Flattening a trajectory onto a coordinate plane, as evo's --project_to_plane.
#pragma once

#include "datasets/core/trajectory.hpp"
#include "metrics/protocols/protocol.hpp"

namespace loopbench {

/// Positions lose the coordinate across the plane; attitudes keep only their Euler angle about it
/// (euler.hpp; for xz that is the pitch, which folds beyond 90 degrees). evo
/// core/trajectory.py:200-230. O(n), nothing for `none`.
void project(Trajectory& trajectory, Plane plane);

}  // namespace loopbench

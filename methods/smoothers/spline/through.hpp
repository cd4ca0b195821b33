/// Interpolating splines in position and rotation, joined by chords where no spline is possible.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "datasets/core/curve.hpp"
#include "methods/report.hpp"
#include "methods/smoothers/spline/interpolate.hpp"

namespace loopbench::methods {

struct SplineControls {
  SplineBasis basis;
  std::vector<Vector3> points;
  std::optional<RotationControls> rotations;  ///< none: no such spline was found
};

/// Returns the curve whose controls `solve` computes from two or more poses, with the count
/// `iterations` of the rotation solve. If no rotation spline through all keyframes exists, splines
/// through parts of them are joined by great arcs, with the count `great_arcs` and a note. Short
/// intervals (pose_runs.hpp) are bridged by chords, with a note.
std::unique_ptr<const Curve> spline_through(
    const Trajectory& keyframes,
    Report& report,
    const std::function<SplineControls(const Trajectory&)>& solve);

}  // namespace loopbench::methods

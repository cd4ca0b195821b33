/// Measures the continuity of a curve where its pieces meet.
#pragma once

#include "methods/smoothers/manifold/curve.hpp"

namespace loopbench::methods::manifold {

/// Largest jumps over all inner nodes. A B-spline of order 3 has its acceleration jumps between
/// nodes.
struct Continuity {
  double position = 0.0;      ///< C0 [m]
  double velocity = 0.0;      ///< C1 [m/s]
  double acceleration = 0.0;  ///< C2 [m/s^2]
  double slope = 0.0;         ///< G1: angle between the tangents [rad]
  double curvature = 0.0;     ///< G2: between the curvature vectors [1/m]
};

/// Measures the jumps. Nodes where the speed on either side is below 1/1000 of the mean speed are
/// ignored for slope and curvature, because the direction is undefined there. O(nodes).
Continuity continuity(const ManifoldCurve& curve);

}  // namespace loopbench::methods::manifold

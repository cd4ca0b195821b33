/// How smoothly the pieces meet, measured and not assumed.
#pragma once

#include "methods/smoothers/manifold/curve.hpp"

namespace loopbench::manifold {

/// Largest jumps over all inner nodes; a B-spline of order 3 has those of its acceleration between.
struct Continuity {
  double position = 0.0;      ///< C0 [m]
  double velocity = 0.0;      ///< C1 [m/s]
  double acceleration = 0.0;  ///< C2 [m/s^2]
  double slope = 0.0;         ///< G1: angle between the tangents [rad]
  double curvature = 0.0;     ///< G2: between the curvature vectors [1/m]
};

/// Slope and curvature are left out where the curve is slower than 1/1000 of its mean speed on
/// either side: it has no direction there. O(nodes).
Continuity continuity(const ManifoldCurve& curve);

}  // namespace loopbench::manifold

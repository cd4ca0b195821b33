/// {T, N, B} along the finished curve: Frenet's where there is one, carried on where there is none.
#pragma once

#include "methods/smoothers/manifold/curve.hpp"
#include "methods/smoothers/manifold/frenet.hpp"

namespace loopbench::manifold {

struct MovingFrames {
  std::vector<Triad> triads;      ///< at every node
  std::vector<double> curvature;  ///< analytic [1/m]
  std::size_t carried = 0;        ///< nodes where Frenet's frame is undefined
  double torsion_max = 0.0;       ///< discrete, over four nodes at a time [1/m]
};

/// Where Frenet's frame is undefined the one before is carried on by double reflection (parallel
/// transport); before the first defined one any triad around the tangent serves, and where the
/// curve stands the tangent stays. O(nodes).
MovingFrames moving_frames(const ManifoldCurve& curve);

}  // namespace loopbench::manifold

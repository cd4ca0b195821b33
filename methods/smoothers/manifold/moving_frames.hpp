/// Frames {T, N, B} along the curve: Frenet frames where defined, propagated frames elsewhere.
#pragma once

#include "methods/smoothers/manifold/curve.hpp"
#include "methods/smoothers/manifold/frenet.hpp"

namespace loopbench::methods::manifold {

struct CurveFrames {
  std::vector<Triad> triads;      ///< at every node
  std::vector<double> curvature;  ///< analytic [1/m]
  std::size_t carried = 0;        ///< number of nodes where the Frenet frame is undefined
  double torsion_max = 0.0;       ///< largest discrete torsion over four consecutive nodes [1/m]
};

/// Where the Frenet frame is undefined, the previous frame is propagated by double reflection
/// (parallel transport). Before the first defined frame an arbitrary triad around the tangent is
/// used. At rest the tangent is kept. O(nodes).
CurveFrames moving_frames(const ManifoldCurve& curve);

}  // namespace loopbench::methods::manifold

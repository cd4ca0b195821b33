/// Weights of an edge in the isotropic chordal cost, as SE-Sync reads them from a g2o file.
#pragma once

#include <Eigen/LU>

#include "datasets/core/problem.hpp"

namespace loopbench::metrics {

/// Cost of an edge: kappa |R_to - R_from Z_R|_F^2 + tau |t_to - t_from - R_from Z_t|^2.
struct ChordalWeights {
  double kappa = 0.0;  ///< [1/rad^2]
  double tau = 0.0;    ///< [1/m^2]
};

/// With S_t and S_phi the inverses of the information's translation and rotation blocks:
/// tau = d / tr(S_t); kappa = 3 / (2 tr(S_phi)) in space (d = 3), the yaw information in the plane
/// (d = 2). Source: Rosen et al., SE-Sync, IJRR 2019, and the reader of its program.
inline ChordalWeights chordal_weights(const Edge& edge, bool planar) {
  const Matrix6& information = edge.information;
  if (planar) {
    const Eigen::Matrix2d S = Eigen::Matrix2d(information.topLeftCorner<2, 2>()).inverse();
    return {information(5, 5), 2.0 / S.trace()};
  }
  const Matrix3 S_t = Matrix3(information.topLeftCorner<3, 3>()).inverse();
  const Matrix3 S_phi = Matrix3(information.bottomRightCorner<3, 3>()).inverse();
  return {1.5 / S_phi.trace(), 3.0 / S_t.trace()};
}

}  // namespace loopbench::metrics

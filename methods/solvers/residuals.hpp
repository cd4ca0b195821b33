/// Residuals of the edges and anchors of a pose graph and their derivatives with respect to the
/// poses.
#pragma once

#include <Eigen/Cholesky>
#include <stdexcept>
#include <string>

#include "datasets/core/anchor.hpp"
#include "methods/solvers/groups/scaled_pose.hpp"

namespace loopbench::methods {

/// e = Log(Z^-1 X_i^-1 X_j) and its derivatives with respect to d in X Exp(d).
template <class G>
struct EdgeResidual {
  typename G::Tangent error;
  typename G::Square by_from;
  typename G::Square by_to;
};

template <class G>
typename G::Tangent group_edge_error(const typename G::Element& to_from_measured_from,
                                     const typename G::Element& from_from_to) {
  return G::log(G::compose(to_from_measured_from, from_from_to));
}

/// `to_from_measured_from` is Z^-1. For X_i Exp(d): Exp(-d) X_i^-1 X_j = X_i^-1 X_j Exp(-Ad(X_j^-1
/// X_i) d).
template <class G>
EdgeResidual<G> edge_residual(const typename G::Element& to_from_measured_from,
                              const typename G::Element& from,
                              const typename G::Element& to) {
  const typename G::Element from_from_to = G::compose(G::inverse(from), to);
  EdgeResidual<G> out;
  out.error = group_edge_error<G>(to_from_measured_from, from_from_to);
  out.by_to = G::inverse_right_jacobian(out.error);
  out.by_from = -out.by_to * G::adjoint(G::inverse(from_from_to));
  return out;
}

/// Returns U with U' U = weight * Omega. Throws std::runtime_error if it is not positive definite.
template <class G>
typename G::Square information_root(const Edge& edge, double weight, double scale_sigma) {
  const Eigen::LLT<typename G::Square> factor(
      typename G::Square(weight * G::information(edge, scale_sigma)));
  if (factor.info() != Eigen::Success) {
    throw std::runtime_error("pose graph: the information matrix of edge " +
                             std::to_string(edge.from) + " - " + std::to_string(edge.to) +
                             " is not positive definite");
  }
  return factor.matrixU();
}

/// e = anchor_error() and its derivative with respect to d in X Exp(d), with d = [rho; phi].
struct AnchorResidual {
  Vector3 error;
  Eigen::Matrix<double, 3, 6> by_pose;
};

inline AnchorResidual anchor_residual(const Anchor& anchor, const Pose& world_from_body) {
  const Matrix3 R = world_from_body.rotation.toRotationMatrix();
  AnchorResidual out;
  out.error = anchor_error(anchor, world_from_body);
  out.by_pose << R, -R * hat(anchor.point_in_body);
  return out;
}

/// Index in [rho; phi] of component `i` < 6 of a twist of the group.
template <class G>
int twist_axis(int i) {
  constexpr int kPlane[] = {0, 1, 5}, kLevel[] = {0, 1, 2, 5};
  if constexpr (G::kDof == 4) return kLevel[i];
  return G::kDof == 3 ? kPlane[i] : i;
}

}  // namespace loopbench::methods

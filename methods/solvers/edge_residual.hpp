/// Residual of a pose-graph edge and its derivatives with respect to both poses, in any group.
#pragma once

#include <Eigen/Cholesky>
#include <stdexcept>
#include <string>

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
  const Eigen::LLT<typename G::Square> factor(weight * G::information(edge, scale_sigma));
  if (factor.info() != Eigen::Success) {
    throw std::runtime_error("pose graph: the information matrix of edge " +
                             std::to_string(edge.from) + " - " + std::to_string(edge.to) +
                             " is not positive definite");
  }
  return factor.matrixU();
}

}  // namespace loopbench::methods

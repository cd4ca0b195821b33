/// What the rest of a solved pose graph predicts for each of its closures.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cstddef>
#include <optional>
#include <vector>

#include "methods/solvers/graph_covariance.hpp"

namespace loopbench::methods {

/// Error of a closure, in the frame of its end, against the solution without it, and covariance of
/// that error, with that of the closure itself.
template <class G>
struct LeftOut {
  typename G::Tangent error;
  typename G::Square covariance;
  double squared = 0.0;  ///< error e' W e at the solution with it [-]
  double redundancy =
      0.0;  ///< expected value of `squared`: kDof without other influence, 0 to kDof
};

/// One per closure, to first order at `poses`, the minimum of solve_pose_graph() with weights of 1
/// and without a loss; nullopt: nothing else determines it, to rounding. With the error e, its
/// information W and the covariance P of the measured motion at the solution, the residuals have
/// the covariance S = W^-1 - P, and without the closure the error is (S W)^-1 e with the covariance
/// (W S W)^-1. Time and memory of one factorisation. Throws std::runtime_error if the information
/// is not positive definite.
template <class G>
std::vector<std::optional<LeftOut<G>>> left_out_closures(const std::vector<ScaledPose>& poses,
                                                         const Problem& problem) {
  using Square = typename G::Square;
  constexpr double kDetermined = 1e-7;  // least share of a residual's variance that is not rounding
  const std::vector<double> weights(problem.closures.size(), 1.0);
  const Information<G> information =
      graph_information<G>(poses, {problem.odometry, problem.closures, weights}, {}, 1);
  const SelectedInverse inverse(information.matrix(poses.size()), G::kDof);
  const auto block = [&](std::size_t i, std::size_t j) -> Square {
    if (i == 0 || j == 0) return Square::Zero();  // does not move
    return inverse.block(static_cast<Eigen::Index>(i - 1), static_cast<Eigen::Index>(j - 1));
  };
  const ScaledPose first_from_world = poses.front().inverse();
  std::vector<std::optional<LeftOut<G>>> out;
  for (const Edge& edge : problem.closures) {
    const EdgeResidual<G> at = edge_residual<G>(G::inverse(G::from(measured(edge))),
                                                G::from(first_from_world * poses[edge.from]),
                                                G::from(first_from_world * poses[edge.to]));
    const Square cross = at.by_from * block(edge.from, edge.to) * at.by_to.transpose();
    const Square predicted = at.by_from * block(edge.from, edge.from) * at.by_from.transpose() +
                             at.by_to * block(edge.to, edge.to) * at.by_to.transpose() + cross +
                             cross.transpose();
    const Square omega = G::information(edge, 1.0);
    const Eigen::LLT<Square> root(omega);
    const Square upper = root.matrixU();
    // In units of the closure's deviations: the share of its variance that is left.
    const Square left = Square::Identity() - upper * predicted * upper.transpose();
    const Eigen::SelfAdjointEigenSolver<Square> axes(left);
    if (!(axes.eigenvalues().minCoeff() > kDetermined)) {
      out.push_back(std::nullopt);
      continue;
    }
    const Square back = root.matrixU().solve(Square::Identity());
    const Square wider = inverse_of(left);
    const typename G::Tangent white = upper * at.error;
    out.push_back(LeftOut<G>{back * (wider * white),
                             back * wider * back.transpose(),
                             white.squaredNorm(),
                             left.trace()});
  }
  return out;
}

}  // namespace loopbench::methods

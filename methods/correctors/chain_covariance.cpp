#include "datasets/core/covariance.hpp"
#include "methods/correctors/looped_chain.hpp"

namespace loopbench::methods {

/// An error e_i moves all later poses by the twist edge[i] e_i in the axes of the chain. With the
/// sum P_j of edge[i] S_i edge[i]' up to keyframe j and M = A S A' + S_L = F F', the covariance of
/// its twist is P_j - C_j' M^-1 C_j = P_j - Y_j' Y_j, where C_j is that of all gaps with the twist
/// and Y_j = F^-1 C_j. Along an edge, the rows of C of the loops that contain it grow by loop[k]
/// edge[i] S_i edge[i]'. The information of the first edge is removed by Woodbury's identity: with
/// X = P_1 - Y_j' Y_1, the covariance of the twists j and 1, it grows by X (Y_1' Y_1)^-1 X'.
std::vector<Matrix6> LoopedChain::covariances(bool has_front) const {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, 6>;
  const LoopEquations at = equations();
  const std::vector<Edge>& closures = problem_.closures;
  const auto size = static_cast<Eigen::Index>(6 * closures.size());
  Eigen::MatrixXd by_loop = Eigen::MatrixXd::Zero(size, size);  // F^-1 loop[k], one per loop
  for (std::size_t k = 0; k < closures.size(); ++k) {
    const auto begin = static_cast<Eigen::Index>(6 * k);
    by_loop.block<6, 6>(begin, begin) = at.jacobian.loop[k];
  }
  at.factor.matrixL().solveInPlace(by_loop);
  const auto of_loop = [&](std::size_t k) {
    return by_loop.middleCols<6>(static_cast<Eigen::Index>(6 * k));
  };
  std::vector<std::vector<std::size_t>> begin(poses_.size()), end(poses_.size());
  for (std::size_t k = 0; k < closures.size(); ++k) {
    begin[closures[k].from].push_back(k);
    end[closures[k].to].push_back(k);
  }
  std::vector<Matrix6> out(poses_.size(), Matrix6::Zero());
  Rows active = Rows::Zero(size, 6);   // sum of F^-1 loop[k] over the loops that contain the edge
  Rows shared = Rows::Zero(size, 6);   // Y_j
  Matrix6 open = Matrix6::Zero();      // P_j
  Rows front = Rows::Zero(size, 6);    // Y_1
  Matrix6 of_front = Matrix6::Zero();  // P_1
  for (std::size_t j = 1; j < poses_.size(); ++j) {
    for (const std::size_t k : begin[j - 1]) active += of_loop(k);
    for (const std::size_t k : end[j - 1]) active -= of_loop(k);
    const Matrix6& edge = at.jacobian.edge[j - 1];
    const Matrix6 added = edge * noise_model_.covariance[j - 1] * edge.transpose();
    open += added;
    shared.noalias() += active * added;
    Matrix6 of_twist = open;
    of_twist.noalias() -= shared.transpose() * shared;
    if (has_front) {
      if (j == 1) front = shared, of_front = open;
      const Matrix6 cross = of_front - shared.transpose() * front;
      // In the plane, other axes may be free.
      const Matrix6 known = front.transpose() * front;
      of_twist += cross * known.completeOrthogonalDecomposition().solve(cross.transpose());
    }
    out[j] = displaced(0.5 * (of_twist + of_twist.transpose()), poses_[j].translation);
    if (problem_.planar) out[j] = planar_covariance(out[j], poses_[j].rotation.toRotationMatrix());
  }
  return out;
}

}  // namespace loopbench::methods

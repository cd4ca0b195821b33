#include "methods/correctors/loop_covariance.hpp"

#include <cmath>
#include <numeric>

namespace loopbench::methods {

Eigen::MatrixXd LoopCovariance::under(const VarianceFactors& factors) const {
  return factors.translation * translation + factors.rotation * rotation +
         std::sqrt(factors.translation * factors.rotation) * mixed + closures;
}

LoopCovariance loop_covariance(const Problem& problem,
                               const NoiseModel& stated,
                               const LoopedChain& chain) {
  const LoopJacobian jacobian = chain.linearise();
  std::vector<std::size_t> all_closures(problem.closures.size());
  std::iota(all_closures.begin(), all_closures.end(), std::size_t{0});
  LoopCovariance out;
  out.rows = gap_rows(all_closures, problem.planar);
  const std::vector<Eigen::Index>& rows = out.rows;
  const auto through = [&](auto part) -> Eigen::MatrixXd {
    const Eigen::MatrixXd all = propagate_covariance(
        jacobian, chain.sums(), running_sum(chain.sums(), [&](std::size_t i) -> Matrix6 {
          return jacobian.edge[i] * part(stated.covariance[i]) * jacobian.edge[i].transpose();
        }));
    return all(rows, rows);
  };
  const auto block = [](const Matrix6& S, Eigen::Index row, Eigen::Index column) {
    Matrix6 out = Matrix6::Zero();
    out.block<3, 3>(row, column) = S.block<3, 3>(row, column);
    return out;
  };
  out.gap = jacobian.gap(rows);
  out.translation = through([&](const Matrix6& S) { return block(S, 0, 0); });
  out.rotation = through([&](const Matrix6& S) { return block(S, 3, 3); });
  out.mixed = through([&](const Matrix6& S) -> Matrix6 { return block(S, 0, 3) + block(S, 3, 0); });
  const auto size = static_cast<Eigen::Index>(6 * problem.closures.size());
  Eigen::MatrixXd closures = Eigen::MatrixXd::Zero(size, size);
  for (std::size_t k = 0; k < problem.closures.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(6 * k);
    closures.block<6, 6>(at, at) = stated.closure_covariance[k];
  }
  out.closures = closures(rows, rows);
  return out;
}

}  // namespace loopbench::methods

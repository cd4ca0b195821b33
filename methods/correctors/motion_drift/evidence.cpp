#include "methods/correctors/motion_drift/evidence.hpp"

namespace loopbench {
namespace {

/// Rows of the full system that a problem has.
std::vector<Eigen::Index> rows_of(const std::vector<std::size_t>& closures, bool planar) {
  const std::vector<int> axes = planar ? std::vector{0, 1, 5} : std::vector{0, 1, 2, 3, 4, 5};
  std::vector<Eigen::Index> out;
  for (const std::size_t k : closures) {
    for (const int axis : axes) out.push_back(static_cast<Eigen::Index>(6 * k) + axis);
  }
  return out;
}

Matrix6 only(Half half, const Matrix6& matrix) {
  Matrix6 out = Matrix6::Zero();
  const Eigen::Index at = half == Half::translation ? 0 : 3;
  out.block<3, 3>(at, at) = matrix.block<3, 3>(at, at);
  return out;
}

}  // namespace

Evidence evidence_of(const MotionModel& model,
                     const LoopedChain& chain,
                     const Problem& problem,
                     const std::vector<EdgeMotion>& motions,
                     const std::vector<std::size_t>& closures) {
  const LoopJacobian jacobian = chain.linearised();
  const LoopSums& sums = chain.sums();
  const std::vector<Eigen::Index> rows = rows_of(closures, problem.planar);
  const auto size = static_cast<Eigen::Index>(6 * sums.loops());

  Evidence out;
  out.gap = jacobian.gap(rows);
  for (const Term& term : model) {
    const auto columns = [&](std::size_t i) {
      return term.half == Half::translation ? jacobian.edge[i].leftCols<3>()
                                            : jacobian.edge[i].rightCols<3>();
    };
    Eigen::MatrixXd share;
    if (term.cause == Cause::noise) {
      share = through_loops(jacobian, sums, running_sum(sums, [&](std::size_t i) -> Matrix6 {
                              return grown(term.growth, motions[i]) * columns(i) *
                                     columns(i).transpose();
                            }));
    } else if (term.cause == Cause::drift) {
      Eigen::MatrixXd shape =
          through_loops_once(jacobian, sums, running_sum(sums, [&](std::size_t i) -> Matrix6 {
                               return grown(term.growth, motions[i]) * jacobian.edge[i];
                             }));
      const Eigen::MatrixXd half =
          term.half == Half::translation ? shape.leftCols<3>() : shape.rightCols<3>();
      share = half * half.transpose();
    } else {
      share = Eigen::MatrixXd::Zero(size, size);
      for (std::size_t k = 0; k < sums.loops(); ++k) {
        const auto at = static_cast<Eigen::Index>(6 * k);
        share.block<6, 6>(at, at) = only(term.half, problem.closures[k].information.inverse());
      }
    }
    share = share.triangularView<Eigen::Lower>();
    out.shares.push_back(share(rows, rows));
  }
  return out;
}

}  // namespace loopbench

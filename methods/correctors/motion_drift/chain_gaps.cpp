#include "methods/correctors/motion_drift/chain_gaps.hpp"

#include <Eigen/Cholesky>
#include <limits>

namespace loopbench::methods {
namespace {

/// Rotation about z in the plane. In space, measured roll and pitch of a vehicle are mostly noise,
/// and the best rate would be -1, which removes all rotation.
double planar_rotation(const Edge& edge, bool planar) {
  return planar ? log_so3(edge.from_from_to.rotation).z() : 0.0;
}

/// Changes of the gaps by the rates, and 0 for rates out of the plane.
Eigen::MatrixXd rate_shapes(const Problem& problem,
                            const LoopJacobian& jacobian,
                            const LoopSums& sums) {
  const auto change = [&](auto shape) -> Eigen::MatrixXd {
    return propagate_drift(jacobian, sums, running_sum(sums, [&](std::size_t i) -> Matrix6 {
                             return shape(problem.odometry[i]) * jacobian.edge[i];
                           }));
  };
  const Eigen::MatrixXd by_length =
      change([](const Edge& edge) { return edge.from_from_to.translation.norm(); });
  const Eigen::MatrixXd by_rotation =
      change([&](const Edge& edge) { return planar_rotation(edge, problem.planar); });
  Eigen::MatrixXd out(jacobian.gap.size(), 4);
  out << by_length.rightCols<3>(), by_rotation.col(5);
  if (problem.planar) out.leftCols<2>().setZero();
  return out;
}

}  // namespace

Problem without_drift(Problem problem, const DriftRates& rates) {
  for (std::size_t i = 0; i < problem.odometry.size(); ++i) {
    const Edge& edge = problem.odometry[i];
    Vector3 error = edge.from_from_to.translation.norm() * rates.head<3>();
    error.z() += planar_rotation(edge, problem.planar) * rates[3];
    Pose& measured = problem.odometry[i].from_from_to;
    measured = normalized(measured * exp_se3(twist(Vector3::Zero(), error)));
    problem.keyframes[i + 1].world_from_body =
        normalized(problem.keyframes[i].world_from_body * measured);
  }
  return problem;
}

ChainGaps::ChainGaps(const Problem& problem, const DriftRates& at) {
  const Problem moved = without_drift(problem, at);
  const NoiseModel stated = stated_noise_model(moved);
  const LoopedChain chain(moved, stated);
  loops_ = loop_covariance(moved, stated, chain);
  shapes_ = rate_shapes(problem, chain.linearise(), chain.sums())(loops_.rows, Eigen::all);
  gap_ = -loops_.gap + shapes_ * at;
}

std::optional<MeasuredRates> ChainGaps::measured(const VarianceFactors& factors,
                                                 const Eigen::VectorXd& gap,
                                                 const Eigen::MatrixXd& added) const {
  const Eigen::LLT<Eigen::MatrixXd, Eigen::Lower> factor(loops_.under(factors) + added);
  if (factor.info() != Eigen::Success) return std::nullopt;
  const Eigen::MatrixXd shapes = factor.matrixL().solve(shapes_);
  const Eigen::VectorXd whitened = factor.matrixL().solve(gap);
  return MeasuredRates{
      shapes.transpose() * whitened,
      shapes.transpose() * shapes,
      0.5 * whitened.squaredNorm() + factor.matrixLLT().diagonal().array().log().sum()};
}

std::optional<MeasuredRates> ChainGaps::measured(const VarianceFactors& factors) const {
  return measured(factors, gap_, Eigen::MatrixXd::Zero(gap_.size(), gap_.size()));
}

double ChainGaps::misfit(const VarianceFactors& factors,
                         const DriftRates& mean,
                         const DriftRates& variance) const {
  const auto out = measured(
      factors, gap_ - shapes_ * mean, shapes_ * variance.asDiagonal() * shapes_.transpose());
  return out ? out->misfit : std::numeric_limits<double>::infinity();
}

}  // namespace loopbench::methods

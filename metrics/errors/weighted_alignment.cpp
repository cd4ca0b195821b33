#include "metrics/errors/weighted_alignment.hpp"

#include <cmath>

namespace loopbench::metrics {
namespace {

template <int Size>
Alignment weighted(const Evaluation& evaluation, const Trajectory& raw, Alignment fit) {
  constexpr int kRounds = 20;
  constexpr double kConverged = 1e-12;  // [m], [rad], [-]
  const std::vector<Eigen::Index> columns = free_columns(fit.type);
  for (int round = 0; round < kRounds && !columns.empty(); ++round) {
    const Trajectory estimate = moved(fit, raw);
    const PairCovariance covariance(evaluation, fit);
    Vector3 middle = Vector3::Zero();
    for (const StampedPose& pose : estimate) middle += pose.world_from_body.translation;
    middle /= static_cast<double>(estimate.size());
    Eigen::Matrix<double, 7, 7> normal = Eigen::Matrix<double, 7, 7>::Zero();
    Eigen::Matrix<double, 7, 1> gradient = Eigen::Matrix<double, 7, 1>::Zero();
    for (std::size_t i = 0; i < estimate.size(); ++i) {
      const auto& [stamp, reference] = evaluation.reference[i];
      const Pose& pose = estimate[i].world_from_body;
      const Vector3 arm = pose.translation - middle;
      Eigen::Matrix<double, 6, 7> jacobian = Eigen::Matrix<double, 6, 7>::Zero();
      jacobian.topLeftCorner<3, 6>() << Matrix3::Identity(), -hat(arm);
      jacobian.block<3, 3>(3, 3).setIdentity();
      jacobian.topRightCorner<3, 1>() = arm;
      using Block = Eigen::Matrix<double, Size, Size>;
      const Matrix6 C = covariance.at(stamp, estimate[i].stamp);
      const CovarianceRoot<Block> root =
          covariance_root(Block(C.topLeftCorner<Size, Size>()), stamp);
      const Eigen::Matrix<double, Size, 7> J =
          root.matrixL().solve(Eigen::Matrix<double, Size, 7>(jacobian.topRows<Size>()));
      const Twist error = error_of(reference, pose, Size == 6);
      const Eigen::Matrix<double, Size, 1> e =
          root.matrixL().solve(Eigen::Matrix<double, Size, 1>(error.head<Size>()));
      normal += J.transpose() * J;
      gradient += J.transpose() * e;
    }
    const Eigen::LDLT<Eigen::MatrixXd> solver(Eigen::MatrixXd(normal(columns, columns)));
    if (!solver.isPositive()) return fit;
    Eigen::Matrix<double, 7, 1> step = Eigen::Matrix<double, 7, 1>::Zero();
    const Eigen::VectorXd solved = solver.solve(Eigen::VectorXd(gradient(columns)));
    step(columns) = solved;
    if (!step.allFinite()) return fit;
    const Rotation rotation = exp_so3(step.segment<3>(3));
    const double scale = std::exp(step[6]);
    Pose& pose = fit.reference_from_estimate;
    pose.translation = middle + scale * (rotation * (pose.translation - middle)) + step.head<3>();
    pose.rotation = (rotation * pose.rotation).normalized();
    fit.scale *= scale;
    if (step.norm() <= kConverged * (1.0 + middle.norm())) break;
  }
  return fit;
}

}  // namespace

std::vector<Eigen::Index> free_columns(Align type) {
  if (type == Align::se3) return {0, 1, 2, 3, 4, 5};
  if (type == Align::sim3) return {0, 1, 2, 3, 4, 5, 6};
  if (type == Align::posyaw) return {0, 1, 2, 5};
  return {};
}

Alignment weighted_alignment(const Evaluation& evaluation,
                             const Trajectory& raw,
                             const Alignment& fit,
                             bool has_rotations) {
  return has_rotations ? weighted<6>(evaluation, raw, fit) : weighted<3>(evaluation, raw, fit);
}

}  // namespace loopbench::metrics

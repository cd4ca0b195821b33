#include "metrics/checks/point_offset.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "datasets/core/interpolate.hpp"
#include "metrics/alignment/alignment.hpp"
#include "metrics/evaluation/evaluation.hpp"
#include "metrics/numerics/autocorrelation.hpp"
#include "metrics/pairing/association.hpp"

namespace loopbench::metrics {
namespace {

constexpr int kAll = 11, kLever = 6, kOffset = 9, kScale = 10;
using Normal = Eigen::Matrix<double, kAll, kAll>;
using Step = Eigen::Matrix<double, kAll, 1>;

/// 97.5 % quantile of Student's distribution, to 1 % from 5 degrees of freedom on.
double student_quantile(double freedom) {
  constexpr double z = 1.959963985;
  const double z3 = z * z * z, z5 = z3 * z * z;
  return z + (z3 + z) / (4.0 * freedom) +
         (5.0 * z5 + 16.0 * z3 + 3.0 * z) / (96.0 * freedom * freedom);
}

/// Solves the normal equations in the directions that they determine. `undetermined`: share of each
/// parameter in the others.
struct Solution {
  Step step = Step::Zero();
  Normal covariance = Normal::Zero();  ///< for residuals of variance 1
  Step undetermined = Step::Zero();
};

Solution solve(const Normal& normal, const Step& gradient, double damping) {
  constexpr double kRank = 1e-10;
  Step scale = normal.diagonal().cwiseSqrt();
  for (double& value : scale) value = value > 0.0 ? value : 1.0;
  const Normal scaled =
      scale.cwiseInverse().asDiagonal() * normal * scale.cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Normal> eigen(scaled);
  Solution out;
  for (int k = 0; k < kAll; ++k) {
    const Step direction = eigen.eigenvectors().col(k);
    const double value = eigen.eigenvalues()[k];
    if (value <= kRank * eigen.eigenvalues()[kAll - 1]) {
      out.undetermined += direction.cwiseAbs2();
      continue;
    }
    const Step scaled_direction = scale.cwiseInverse().asDiagonal() * direction;
    out.step -= scaled_direction * (scaled_direction.dot(gradient) / (value + damping));
    out.covariance += scaled_direction * scaled_direction.transpose() / value;
  }
  return out;
}

/// Whether the direction of a body axis in the world changes by at least 0.1 rad (rms). Otherwise
/// drift of the estimate would be taken for a lever arm along it.
std::array<bool, 3> are_changing_axes(const Trajectory& estimate) {
  constexpr double kLeastChange = 0.1;
  std::array<bool, 3> out{};
  for (int axis = 0; axis < 3; ++axis) {
    Vector3 mean = Vector3::Zero();
    for (const auto& [stamp, pose] : estimate) mean += pose.rotation * Vector3::Unit(axis);
    mean /= static_cast<double>(estimate.size());
    out[static_cast<std::size_t>(axis)] = 1.0 - mean.squaredNorm() >= kLeastChange * kLeastChange;
  }
  return out;
}

Rotation moved_rotation(const PointOffsetProblem& problem) {
  return (exp_so3(problem.x.head<3>()) * problem.rotation).normalized();
}

}  // namespace

double PointOffset::half_width(int i) const {
  if (!is_observable[static_cast<std::size_t>(i)]) return std::numeric_limits<double>::infinity();
  return interval_factor * std::sqrt(covariance(i, i));
}

void PointOffsetProblem::evaluate(double longest,
                                  Eigen::VectorXd& residuals,
                                  Eigen::MatrixXd* jacobian) const {
  const Rotation R = moved_rotation(*this);
  const Vector3 translation = x.segment<3>(3), lever_arm = x.segment<3>(kLever);
  const double offset = x[kOffset], scale = x[kScale];
  residuals.resize(static_cast<Eigen::Index>(3 * reference.size()));
  if (jacobian) jacobian->setZero(residuals.size(), kAll);
  Eigen::Index row = 0;
  std::size_t after = 1;
  for (const auto& [stamp, pose] : reference) {
    const double time = stamp - offset;
    while (after < estimate.size() && estimate[after].stamp < time) ++after;
    if (after == estimate.size() || time < estimate[after - 1].stamp) continue;
    const auto& [t0, from] = estimate[after - 1];
    const auto& [t1, to] = estimate[after];
    if (t1 - t0 > longest + kStampRounding) continue;
    const Pose at = interpolate(from, to, (time - t0) / (t1 - t0));
    const Vector3 moved = R * (at.translation + at.rotation * lever_arm);
    residuals.segment<3>(row) = pose.translation - scale * moved - translation;
    if (jacobian) {
      const Vector3 rate = log_so3(from.rotation.conjugate() * to.rotation) / (t1 - t0);
      const Vector3 velocity =
          (to.translation - from.translation) / (t1 - t0) + at.rotation * rate.cross(lever_arm);
      auto J = jacobian->middleRows<3>(row);
      // Left of R, at the current rotation: exp(x + d) = exp(J d) exp(x).
      J.leftCols<3>() = scale * hat(moved) * left_jacobian_so3(x.head<3>());
      J.middleCols<3>(3) = -Matrix3::Identity();
      J.middleCols<3>(kLever) = -scale * (R * at.rotation).toRotationMatrix();
      J.col(kOffset) = scale * (R * velocity);
      J.col(kScale) = -moved;
    }
    row += 3;
  }
  residuals.conservativeResize(row);
  if (jacobian) jacobian->conservativeResize(row, kAll);
}

PointOffset fit_point_offset(const Trajectory& reference,
                             const Trajectory& estimate,
                             bool with_scale,
                             double longest) {
  constexpr std::size_t kFewest = 5;
  const Paired start = interpolate_estimate(reference, estimate, longest, 0.0);
  if (start.reference.size() < kFewest) {
    throw Undefined("lever arm: " + std::to_string(start.reference.size()) +
                    " positions of the reference lie between poses of the estimate, "
                    "expected at least 5");
  }
  const Alignment fit =
      align(start.reference, start.estimate, with_scale ? Align::sim3 : Align::se3);
  PointOffsetProblem problem{
      reference, estimate, fit.reference_from_estimate.rotation, Step::Zero()};
  problem.x.segment<3>(3) = fit.reference_from_estimate.translation;
  problem.x[kScale] = fit.scale;

  Eigen::VectorXd residuals;
  Eigen::MatrixXd jacobian;
  problem.evaluate(longest, residuals, &jacobian);
  const auto mean_square = [](const Eigen::VectorXd& r) {
    return 3.0 * r.squaredNorm() / static_cast<double>(r.size());
  };
  PointOffset out;
  out.rmse_before = std::sqrt(mean_square(residuals));
  double damping = 1e-4;
  Solution solution;
  for (int round = 0; round < 100; ++round) {
    Normal normal = jacobian.transpose() * jacobian;
    Step gradient = jacobian.transpose() * residuals;
    if (!with_scale) {
      normal.row(kScale).setZero();
      normal.col(kScale).setZero();
      gradient[kScale] = 0.0;
    }
    solution = solve(normal, gradient, damping);
    PointOffsetProblem next = problem;
    next.x += solution.step;
    Eigen::VectorXd after;
    Eigen::MatrixXd derivative;
    next.evaluate(longest, after, &derivative);
    // As many points as before are needed: a large offset would leave the estimate's time.
    const bool is_kept = 10 * after.size() >= 9 * residuals.size();
    if (is_kept && mean_square(after) <= mean_square(residuals)) {
      const double change = solution.step.cwiseAbs().maxCoeff();
      problem = next;
      residuals = after;
      jacobian = derivative;
      damping = std::max(0.1 * damping, 1e-12);
      if (change < 1e-9) break;
    } else {
      damping *= 10.0;
      if (damping > 1e6) break;
    }
  }
  const double freedom = static_cast<double>(residuals.size()) - (with_scale ? 11.0 : 10.0);
  out.points = static_cast<std::size_t>(residuals.size() / 3);
  out.lever_arm = problem.x.segment<3>(kLever);
  out.offset = problem.x[kOffset];
  out.rmse = std::sqrt(mean_square(residuals));
  out.correlated = integrated_autocorrelation(residuals, 3);
  const double variance = freedom > 0.0 ? out.correlated * residuals.squaredNorm() / freedom : 0.0;
  out.interval_factor = student_quantile(std::max(1.0, freedom / out.correlated));
  out.covariance = variance * solution.covariance.block<4, 4>(kLever, kLever);
  constexpr double kLeastShare = 1e-6;
  const std::array<bool, 3> is_changing = are_changing_axes(start.estimate);
  for (std::size_t i = 0; i < PointOffset::kParameters; ++i) {
    const auto k = static_cast<int>(i);
    out.is_observable[i] = freedom > 0.0 && solution.undetermined[kLever + k] < kLeastShare;
    if (i < 3 && !is_changing[i]) out.is_observable[i] = false;
    if (out.is_observable[i]) continue;
    out.covariance.row(k).setZero();
    out.covariance.col(k).setZero();
    out.covariance(k, k) = std::numeric_limits<double>::infinity();
  }
  return out;
}

}  // namespace loopbench::metrics

#include "metrics/doctor/frame_fit.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "metrics/doctor/common_motion.hpp"

namespace loopbench::metrics {
namespace {

using Svd = Eigen::JacobiSVD<Matrix3>;

/// -1 if the orthogonal matrix that maximises trace(Q^T M) is a reflection, else 1.
double sign_of(const Svd& svd) {
  return (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
}

/// Rotation R that maximises trace(R^T M).
Matrix3 closest(const Svd& svd) {
  return svd.matrixU() * Vector3(1.0, 1.0, sign_of(svd)).asDiagonal() * svd.matrixV().transpose();
}

/// The rotation that is closest to the sum of rotations.
Rotation mean_rotation(const Matrix3& sum) {
  const Svd svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return Rotation(closest(svd)).normalized();
}

}  // namespace

PositionFit fit_positions(const std::vector<Pose>& reference, const std::vector<Pose>& estimate) {
  PositionFit out;
  if (reference.size() < 4) return out;
  const auto n = static_cast<double>(reference.size());
  Vector3 mean_r = Vector3::Zero(), mean_e = Vector3::Zero();
  for (std::size_t i = 0; i < reference.size(); ++i) {
    mean_r += reference[i].translation / n;
    mean_e += estimate[i].translation / n;
  }
  Matrix3 covariance = Matrix3::Zero();
  double var_r = 0.0, var_e = 0.0;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const Vector3 r = reference[i].translation - mean_r;
    const Vector3 e = estimate[i].translation - mean_e;
    covariance += r * e.transpose() / n;
    var_r += r.squaredNorm() / n;
    var_e += e.squaredNorm() / n;
  }
  if (!(var_r > 0.0) || !(var_e > 0.0)) return out;
  const Svd svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vector3& d = svd.singularValues();
  if (!(d[0] > 0.0)) return out;
  out.rotation = closest(svd);
  const double proper = d[0] + d[1] + sign_of(svd) * d[2];
  const auto relative = [&](double square) { return std::sqrt(std::max(0.0, square) / var_r); };
  out.scale = proper / var_e;
  out.similarity = relative(var_r - proper * proper / var_e);
  out.rigid = relative(var_r + var_e - 2.0 * proper);
  out.rmse_similarity = out.similarity * std::sqrt(var_r);
  out.rmse_rigid = out.rigid * std::sqrt(var_r);
  return out;
}

ConstantRotations fit_rotations(const std::vector<Pose>& reference,
                                const std::vector<Pose>& estimate) {
  ConstantRotations out;
  const std::size_t n = reference.size();
  if (n < 8) return out;
  // Relative rotations over a range of distances, so that slow and fast motion count.
  Matrix3 sum = Matrix3::Zero();
  double of_reference = 0.0, of_estimate = 0.0;  // [rad^2]
  for (const std::size_t step : {std::size_t{1}, n / 50 + 1, n / 10 + 1}) {
    for (std::size_t i = 0; i + step < n; ++i) {
      const auto vector = [&](const std::vector<Pose>& list) {
        return log_so3(list[i].rotation.conjugate() * list[i + step].rotation);
      };
      // right^T maps the reference's rotation vectors from the estimate's.
      const Vector3 e = vector(estimate), r = vector(reference);
      sum += e * r.transpose();
      of_reference += r.squaredNorm();
      of_estimate += e.squaredNorm();
    }
  }
  out.right = mean_rotation(sum);
  if (of_reference > 0.0) {
    const double common = (out.right.toRotationMatrix().transpose() * sum).trace();
    out.relative =
        std::sqrt(std::max(0.0, of_reference + of_estimate - 2.0 * common) / of_reference);
  }
  Matrix3 lefts = Matrix3::Zero();
  for (std::size_t i = 0; i < n; ++i) {
    lefts +=
        (reference[i].rotation * (estimate[i].rotation * out.right).conjugate()).toRotationMatrix();
  }
  out.left = mean_rotation(lefts);
  std::vector<double> angles;
  for (std::size_t i = 0; i < n; ++i) {
    angles.push_back(
        angle_between(reference[i].rotation, out.left * estimate[i].rotation * out.right));
  }
  out.residual = median_value(std::move(angles));
  return out;
}

RotationErrors rotation_errors(const std::vector<Pose>& reference,
                               const std::vector<Pose>& estimate,
                               const Rotation& left) {
  std::vector<Rotation> errors;  // estimate_body_from_reference_body
  Matrix3 sum = Matrix3::Zero();
  for (std::size_t i = 0; i < reference.size(); ++i) {
    errors.push_back((left * estimate[i].rotation).conjugate() * reference[i].rotation);
    sum += errors.back().toRotationMatrix();
  }
  const auto median_angle_to = [&](const Rotation& body) {
    std::vector<double> angles;
    for (const Rotation& error : errors) angles.push_back(angle_between(error, body));
    return median_value(std::move(angles));
  };
  const Rotation body = mean_rotation(sum);
  return {median_angle_to(Rotation::Identity()), median_angle_to(body), body};
}

}  // namespace loopbench::metrics

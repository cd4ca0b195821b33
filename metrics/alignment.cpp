#include "metrics/alignment.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <limits>

#include "datasets/core/parallel.hpp"
#include "metrics/moments.hpp"

namespace loopbench {
namespace {

// Singular values carry rounding of about 1e-16 of the first. Below this share the rotation about
// the main direction would have fewer than four digits.
constexpr double kFlat = 1e-12;

/// No wider than the rounding of its own coordinates.
bool is_point(double spread, double count, const Vector3& mean) {
  const double rounding = 16.0 * std::numeric_limits<double>::epsilon() * mean.norm();
  return spread <= count * rounding * rounding;
}

std::runtime_error degenerate(Align type, double count, const std::string& why) {
  const std::string pairs = std::to_string(static_cast<std::size_t>(count)) + " pairs";
  return std::runtime_error("alignment " + to_text(type) + ": " + pairs + " " + why +
                            ", so the rotation is not unique; align by origin or none");
}

Alignment least_squares(const Trajectory& reference, const Trajectory& estimate, Align type) {
  const Moments m = moments(reference, estimate);
  if (is_point(m.reference_spread, m.count, m.reference_mean) ||
      is_point(m.estimate_spread, m.count, m.estimate_mean)) {
    throw degenerate(type, m.count, "lie in one point");
  }
  const Eigen::JacobiSVD<Matrix3> svd(m.cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vector3 d = svd.singularValues();
  const double mirror =
      svd.matrixU().determinant() * svd.matrixV().determinant() < 0.0 ? -1.0 : 1.0;
  const double flat = kFlat * d[0];

  Alignment out;
  out.type = type;
  out.rank = d[0] > 0.0 ? 1 + (d[1] > flat) + (d[2] > flat) : 0;
  if (out.rank == 0) throw degenerate(type, m.count, "move without any common direction");
  if (out.rank == 1) throw degenerate(type, m.count, "lie on one straight line");
  if (d[1] + mirror * d[2] <= flat) throw degenerate(type, m.count, "mirror the reference");
  out.condition = d[0] / d[1];

  const Vector3 signs(1.0, 1.0, mirror);
  const Matrix3 R = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  if (type == Align::sim3) out.scale = d.dot(signs) / m.estimate_spread;
  out.reference_from_estimate.rotation = Rotation(R).normalized();
  out.reference_from_estimate.translation = m.reference_mean - out.scale * (R * m.estimate_mean);
  return out;
}

}  // namespace

Alignment align(const Trajectory& reference, const Trajectory& estimate, Align type) {
  if (reference.size() != estimate.size()) throw std::invalid_argument("align: sizes differ");
  if (reference.empty()) throw std::invalid_argument("align: no poses");
  if (type == Align::se3 || type == Align::sim3) return least_squares(reference, estimate, type);
  Alignment out;
  out.type = type;
  if (type == Align::origin) {
    out.reference_from_estimate =
        normalized(reference[0].world_from_body * estimate[0].world_from_body.inverse());
  }
  return out;
}

Trajectory moved(const Alignment& alignment, Trajectory estimate) {
  if (alignment.type == Align::none) return estimate;
  const Pose& move = alignment.reference_from_estimate;
  const Matrix3 scaled = alignment.scale * move.rotation.toRotationMatrix();
  in_blocks(estimate.size(), [&](std::size_t i, std::size_t end) {
    for (; i < end; ++i) {
      Pose& pose = estimate[i].world_from_body;
      pose.translation = scaled * pose.translation + move.translation;
      pose.rotation = move.rotation * pose.rotation;
    }
  });
  return estimate;
}

}  // namespace loopbench

#include "metrics/alignment/alignment.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "datasets/core/parallel.hpp"
#include "datasets/core/rotation_between.hpp"
#include "datasets/core/trajectory.hpp"

namespace loopbench::metrics {
namespace {

/// Means, variances and cross covariance of two paired point lists, accurate far from the origin.
/// Source: T. Chan, G. Golub, R. LeVeque, Updating formulae and a pairwise algorithm for computing
/// sample variances, 1979.
struct Moments {
  double count = 0.0;
  Vector3 reference_mean = Vector3::Zero();
  Vector3 estimate_mean = Vector3::Zero();
  /// Sums of squared distances from the means, not divided by count [m^2].
  double reference_dispersion = 0.0;
  double estimate_dispersion = 0.0;
  Matrix3 cross = Matrix3::Zero();  ///< sum of (reference - mean) * (estimate - mean)^T
};

// 256 pairs are 32 kB: read twice, loaded into the cache once.
constexpr std::size_t kBlock = 256;

Moments block_moments(const Trajectory& reference,
                      const Trajectory& estimate,
                      std::size_t begin,
                      std::size_t end) {
  // Relative to the block's first point, so that equal points give exactly zero variance.
  const Vector3 p0 = reference[begin].world_from_body.translation;
  const Vector3 q0 = estimate[begin].world_from_body.translation;
  Moments out;
  out.count = static_cast<double>(end - begin);
  Vector3 p_sum = Vector3::Zero();
  Vector3 q_sum = Vector3::Zero();
  for (std::size_t i = begin; i < end; ++i) {
    p_sum += reference[i].world_from_body.translation - p0;
    q_sum += estimate[i].world_from_body.translation - q0;
  }
  const Vector3 p_mean = p_sum / out.count;
  const Vector3 q_mean = q_sum / out.count;
  for (std::size_t i = begin; i < end; ++i) {
    const Vector3 p = reference[i].world_from_body.translation - p0 - p_mean;
    const Vector3 q = estimate[i].world_from_body.translation - q0 - q_mean;
    out.reference_dispersion += p.squaredNorm();
    out.estimate_dispersion += q.squaredNorm();
    out.cross.noalias() += p * q.transpose();
  }
  out.reference_mean = p0 + p_mean;
  out.estimate_mean = q0 + q_mean;
  return out;
}

Moments merged(const Moments& a, const Moments& b) {
  const Vector3 p = b.reference_mean - a.reference_mean;
  const Vector3 q = b.estimate_mean - a.estimate_mean;
  Moments out;
  out.count = a.count + b.count;
  const double share = b.count / out.count;
  const double weight = a.count * share;
  out.reference_mean = a.reference_mean + share * p;
  out.estimate_mean = a.estimate_mean + share * q;
  out.reference_dispersion =
      a.reference_dispersion + b.reference_dispersion + weight * p.squaredNorm();
  out.estimate_dispersion =
      a.estimate_dispersion + b.estimate_dispersion + weight * q.squaredNorm();
  out.cross = a.cross + b.cross + weight * p * q.transpose();
  return out;
}

/// Moments of paired lists of equal size. O(n), one pass: blocks that fit into the cache are
/// centred on their own mean, then merged.
Moments moments(const Trajectory& reference, const Trajectory& estimate) {
  if (reference.empty()) return {};
  std::vector<Moments> blocks((reference.size() + kBlock - 1) / kBlock);
  parallel_for_blocks(reference.size(), [&](std::size_t first, std::size_t last) {
    // A block is processed by the thread that has its first pair.
    for (std::size_t k = (first + kBlock - 1) / kBlock; k * kBlock < last; ++k) {
      const std::size_t end = std::min((k + 1) * kBlock, reference.size());
      blocks[k] = block_moments(reference, estimate, k * kBlock, end);
    }
  });
  Moments out = blocks.front();
  for (std::size_t k = 1; k < blocks.size(); ++k) out = merged(out, blocks[k]);
  return out;
}

// Singular values have a rounding error of about 1e-16 of the first. Below this ratio the rotation
// about the main direction would have fewer than four digits.
constexpr double kFlat = 1e-12;

/// Whether the points differ by no more than the rounding of their coordinates.
bool is_point(double dispersion, double count, const Vector3& mean) {
  const double rounding = 16.0 * std::numeric_limits<double>::epsilon() * mean.norm();
  return dispersion <= count * rounding * rounding;
}

std::runtime_error degenerate(Align type, double count, const std::string& why) {
  const std::string pairs = std::to_string(static_cast<std::size_t>(count)) + " pairs";
  return std::runtime_error("alignment " + to_text(type) + ": " + pairs + " " + why +
                            ", so the rotation is not unique; use align = origin or none");
}

/// Throws if the points are one point, or too far apart.
Moments checked_moments(const Trajectory& reference, const Trajectory& estimate, Align type) {
  const Moments m = moments(reference, estimate);
  if (!std::isfinite(m.reference_dispersion) || !std::isfinite(m.estimate_dispersion) ||
      !m.cross.allFinite()) {
    throw degenerate(type, m.count, "are too far apart for double precision");
  }
  if (is_point(m.reference_dispersion, m.count, m.reference_mean) ||
      is_point(m.estimate_dispersion, m.count, m.estimate_mean)) {
    throw degenerate(type, m.count, "coincide in one point");
  }
  return m;
}

Alignment least_squares(const Trajectory& reference, const Trajectory& estimate, Align type) {
  const Moments m = checked_moments(reference, estimate, type);
  const Eigen::JacobiSVD<Matrix3> svd(m.cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vector3& d = svd.singularValues();
  const double mirror =
      svd.matrixU().determinant() * svd.matrixV().determinant() < 0.0 ? -1.0 : 1.0;
  const double flat = kFlat * d[0];

  Alignment out;
  out.type = type;
  out.rank = d[0] > 0.0 ? 1 + (d[1] > flat) + (d[2] > flat) : 0;
  if (out.rank == 0) throw degenerate(type, m.count, "have no common direction of motion");
  if (out.rank == 1) throw degenerate(type, m.count, "lie on one straight line");
  if (d[1] + mirror * d[2] <= flat) {
    throw degenerate(type, m.count, "are mirror images of the reference");
  }
  out.condition = d[0] / d[1];

  const Vector3 signs(1.0, 1.0, mirror);
  const Matrix3 R = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  if (type != Align::se3) out.scale = d.dot(signs) / m.estimate_dispersion;
  if (type == Align::scale) return out;
  out.reference_from_estimate.rotation = Rotation(R).normalized();
  out.reference_from_estimate.translation = m.reference_mean - out.scale * (R * m.estimate_mean);
  return out;
}

/// The yaw of the best alignment, from `turned` = sum of e r^T or R_e R_r^T.
Rotation best_yaw(const Matrix3& relative_rotation) {
  const double sine = relative_rotation(0, 1) - relative_rotation(1, 0);
  const double cosine = relative_rotation(0, 0) + relative_rotation(1, 1);
  return exp_so3(Vector3(0.0, 0.0, std::atan2(sine, cosine)));
}

Alignment yaw_least_squares(const Trajectory& reference, const Trajectory& estimate) {
  const Moments m = moments(reference, estimate);
  const double sine_sum = std::hypot(m.cross(1, 0) - m.cross(0, 1), m.cross(0, 0) + m.cross(1, 1));
  if (sine_sum <= kFlat * std::sqrt(m.reference_dispersion * m.estimate_dispersion)) {
    throw degenerate(Align::posyaw, m.count, "have no common motion normal to z");
  }
  Alignment out;
  out.type = Align::posyaw;
  const Rotation R = best_yaw(m.cross.transpose());
  out.reference_from_estimate = {R, m.reference_mean - R * m.estimate_mean};
  return out;
}

Alignment first_yaw(const Pose& reference, const Pose& estimate) {
  Alignment out;
  out.type = Align::posyaw_origin;
  const Rotation relative_rotation = estimate.rotation * reference.rotation.conjugate();
  const Rotation R = best_yaw(relative_rotation.toRotationMatrix());
  out.reference_from_estimate = {R, reference.translation - R * estimate.translation};
  return out;
}

Trajectory head(const Trajectory& poses, std::size_t count) {
  return {poses.begin(), poses.begin() + static_cast<std::ptrdiff_t>(count)};
}

/// Rotation that moves one normal to the other and maximises trace(R^T cross), with that trace.
struct PlaneRotation {
  Rotation rotation;
  double trace = 0.0;

  PlaneRotation(const Matrix3& moments, const Vector3& from, const Vector3& n) {
    const Rotation upright = rotation_between(from, n);
    const Matrix3 cross = moments * upright.toRotationMatrix().transpose();
    const double cosine = cross.trace() - n.dot(cross * n);
    const double sine = n.dot(
        Vector3(cross(2, 1) - cross(1, 2), cross(0, 2) - cross(2, 0), cross(1, 0) - cross(0, 1)));
    trace = std::hypot(cosine, sine);
    rotation = (exp_so3(std::atan2(sine, cosine) * n) * upright).normalized();
  }
};

}  // namespace

std::optional<Alignment> align_in_plane(const Trajectory& reference,
                                        const Trajectory& estimate,
                                        Align type,
                                        const PlaneNormals& normals,
                                        std::size_t first) {
  if (first > 0 && first < reference.size()) {
    return align_in_plane(head(reference, first), head(estimate, first), type, normals);
  }
  const Moments m = checked_moments(reference, estimate, type);
  const PlaneRotation best(m.cross, normals.estimate, normals.reference);
  const auto squared_error = [&](double trace) {
    if (type != Align::sim3) return m.reference_dispersion + m.estimate_dispersion - 2.0 * trace;
    return m.reference_dispersion - trace * trace / m.estimate_dispersion;
  };
  constexpr double kLarge = 0.1, kClear = 1.0 / 16.0;  // shares of squared errors
  const double error = squared_error(best.trace);
  if (!normals.are_certain && error > kLarge * m.reference_dispersion) {
    const PlaneRotation turned(m.cross, -normals.estimate, normals.reference);
    if (squared_error(turned.trace) < kClear * error) return std::nullopt;
  }
  if (!(best.trace > kFlat * std::sqrt(m.reference_dispersion * m.estimate_dispersion))) {
    throw degenerate(type, m.count, "have no common motion in the plane");
  }
  Alignment out;
  out.type = type;
  out.rank = 2;
  if (type == Align::sim3) out.scale = best.trace / m.estimate_dispersion;
  const Rotation& R = best.rotation;
  out.reference_from_estimate = {R, m.reference_mean - out.scale * (R * m.estimate_mean)};
  return out;
}

Alignment align(const Trajectory& reference,
                const Trajectory& estimate,
                Align type,
                std::size_t first) {
  if (reference.size() != estimate.size()) throw std::invalid_argument("align: sizes differ");
  if (reference.empty()) throw std::invalid_argument("align: no poses");
  if (first > 0 && first < reference.size()) {
    return align(head(reference, first), head(estimate, first), type);
  }
  Alignment out;
  out.type = type;
  switch (type) {
    case Align::se3:
    case Align::sim3:
    case Align::scale:
      return least_squares(reference, estimate, type);
    case Align::posyaw:
      return yaw_least_squares(reference, estimate);
    case Align::posyaw_origin:
      return first_yaw(reference[0].world_from_body, estimate[0].world_from_body);
    case Align::origin:
      out.reference_from_estimate =
          normalized(reference[0].world_from_body * estimate[0].world_from_body.inverse());
      break;
    case Align::none:
      break;
  }
  return out;
}

Trajectory moved(const Alignment& alignment, Trajectory estimate) {
  if (alignment.type == Align::none) return estimate;
  const Pose& move = alignment.reference_from_estimate;
  const Matrix3 scaled = alignment.scale * move.rotation.toRotationMatrix();
  parallel_for_blocks(estimate.size(), [&](std::size_t i, std::size_t end) {
    for (; i < end; ++i) {
      Pose& pose = estimate[i].world_from_body;
      pose.translation = scaled * pose.translation + move.translation;
      pose.rotation = move.rotation * pose.rotation;
    }
  });
  return estimate;
}

}  // namespace loopbench::metrics

/// Alignment weighted by the covariances of both trajectories.
#pragma once

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <stdexcept>
#include <vector>

#include "datasets/core/covariance.hpp"
#include "metrics/evaluation/evaluation.hpp"

namespace loopbench::metrics {

/// Covariance of the errors of pairs: that of the aligned estimate and that of the reference.
class PairCovariance {
 public:
  PairCovariance(const Evaluation& evaluation, const Alignment& alignment)
      : context_(evaluation.context),
        rotation_(alignment.reference_from_estimate.rotation.toRotationMatrix()),
        scale_(alignment.scale) {}

  Matrix6 at(double reference_stamp, double estimate_stamp) const {
    Matrix6 out =
        rotated(covariance_at(*context_.estimate, *context_.estimate_covariances, estimate_stamp),
                rotation_,
                scale_);
    if (context_.reference_covariances != nullptr) {
      out += covariance_at(*context_.reference, *context_.reference_covariances, reference_stamp);
    }
    return out;
  }

 private:
  const Context& context_;
  Matrix3 rotation_;
  double scale_;
};

/// Position error and logarithm of the rotation error; zero without rotations.
inline Twist error_of(const Pose& reference, const Pose& estimate, bool has_rotations) {
  Twist out = Twist::Zero();
  out.head<3>() = reference.translation - estimate.translation;
  if (has_rotations) out.tail<3>() = log_so3(reference.rotation * estimate.rotation.conjugate());
  return out;
}

template <class Matrix>
using CovarianceRoot = Eigen::LLT<Matrix>;

/// Cholesky factor. Throws std::runtime_error if the covariance is not positive definite.
template <class Matrix>
CovarianceRoot<Matrix> covariance_root(const Matrix& covariance, double stamp) {
  CovarianceRoot<Matrix> out(covariance);
  if (out.info() == Eigen::Success) return out;
  throw std::runtime_error(
      fmt::format("the covariance at stamp {:.9f} is not positive definite", stamp));
}

/// Columns of a change [translation; rotation; log scale] that an alignment by least squares has;
/// none for other alignments.
std::vector<Eigen::Index> free_columns(Align type);

/// Minimises the sum of e^T C^-1 e over the free columns of the alignment `fit`, from it, where e
/// are the errors of pose or, without rotations, of position, and `raw` is the estimate before
/// alignment. Gauss-Newton about the mean position; other alignments are returned unchanged. The
/// context has the covariances. Throws std::runtime_error if C is not positive definite. O(n log n)
/// per iteration, at most 20.
Alignment weighted_alignment(const Evaluation& evaluation,
                             const Trajectory& raw,
                             const Alignment& fit,
                             bool has_rotations);

}  // namespace loopbench::metrics

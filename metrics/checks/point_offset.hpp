/// Lever arm and clock of a reference that is a point of the body: a prism or an antenna.
#pragma once

#include <Eigen/Core>
#include <array>

#include "datasets/core/trajectory.hpp"

namespace loopbench::metrics {

/// Scale 1 unless `with_scale`. Position of the point at stamp t of the reference:
///
///     p(t) = scale R (x(t - offset) + Q(t - offset) lever_arm) + translation
struct PointOffset {
  static constexpr int kParameters = 4;                  ///< lever arm x y z [m], offset [s]
  Vector3 lever_arm = Vector3::Zero();                   ///< in the estimate's body frame [m]
  double offset = 0.0;                                   ///< added to the estimate's stamps [s]
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();  ///< of lever arm and offset
  /// False for parameters that the motion does not determine: along a body axis whose direction
  /// changes by less than 0.1 rad (a vehicle's vertical axis), no speed. Their variance is
  /// infinite.
  std::array<bool, kParameters> is_observable{};
  double interval_factor = 1.96;  ///< half-width of the 95 % interval over the deviation (Student)
  double rmse_before = 0.0;       ///< after an alignment alone [m]
  double rmse = 0.0;              ///< [m]
  std::size_t points = 0;
  /// Integrated autocorrelation of the residuals, by which the covariance is multiplied, at
  /// least 1.
  double correlated = 1.0;

  /// Half-width of the 95 % interval of parameter i; infinite if it is not observable.
  double half_width(int i) const;
};

/// Residuals of the reference positions and their derivatives, for tests. `x`: rotation vector
/// (left of R), translation, lever arm, offset, scale.
struct PointOffsetProblem {
  Trajectory reference;
  Trajectory estimate;
  Rotation rotation;  ///< R
  Eigen::Matrix<double, 11, 1> x;

  /// Three rows for each position between two poses of the estimate at most `longest` [s] apart.
  void evaluate(double longest, Eigen::VectorXd& residuals, Eigen::MatrixXd* jacobian) const;
};

/// Least squares (Levenberg-Marquardt) of alignment, lever arm and offset. The estimate is
/// interpolated between poses at most `longest` [s] apart. The covariance assumes residuals of one
/// variance, correlated in time as they are; drift over the whole path is not in it. Throws
/// Undefined if fewer than five positions of the reference lie between poses of the estimate, and
/// std::runtime_error if the alignment alone is not unique. O(points * rounds).
PointOffset fit_point_offset(const Trajectory& reference,
                             const Trajectory& estimate,
                             bool with_scale,
                             double longest);

}  // namespace loopbench::metrics

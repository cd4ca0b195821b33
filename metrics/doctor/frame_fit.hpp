/// Least-squares fits of two lists of poses, up to constant transforms.
#pragma once

#include <vector>

#include "datasets/core/pose.hpp"

namespace loopbench::metrics {

struct PositionFit {
  Matrix3 rotation = Matrix3::Identity();  ///< reference_from_estimate
  double scale = 1.0;
  double similarity = 1.0;  ///< rmse after a similarity over the reference's standard deviation [-]
  double rigid = 1.0;       ///< the same after a rigid transform
  double rmse_rigid = 0.0;  ///< [m]
  double rmse_similarity = 0.0;  ///< [m]
};

/// Fits positions (Umeyama 1991). Residuals are 1 for fewer than four poses. O(n).
PositionFit fit_positions(const std::vector<Pose>& reference, const std::vector<Pose>& estimate);

struct ConstantRotations {
  Rotation left = Rotation::Identity();   ///< reference_world_from_estimate_world
  Rotation right = Rotation::Identity();  ///< estimate_body_from_reference_body
  double residual = 3.15;                 ///< median angle of R_ref^T left R_est right [rad]
  /// Error of relative rotations after `right`, over the reference's [-]; little affected by drift.
  double relative = 1.0;
};

/// Fits R_ref = left R_est right: `right` from relative rotations (Kabsch), then `left`. O(n).
ConstantRotations fit_rotations(const std::vector<Pose>& reference,
                                const std::vector<Pose>& estimate);

/// Median angles of R_ref^T R_est in the reference's world [rad].
struct RotationErrors {
  double as_read = 3.15;
  double of_another_body = 3.15;                        ///< after `body_from_reference`
  Rotation body_from_reference = Rotation::Identity();  ///< constant rotation that fits best
};

/// `left`: reference_world_from_estimate_world. O(n).
RotationErrors rotation_errors(const std::vector<Pose>& reference,
                               const std::vector<Pose>& estimate,
                               const Rotation& left);

}  // namespace loopbench::metrics

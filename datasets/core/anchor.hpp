/// Absolute position measurements: surveyed control points, GNSS, a total station.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "datasets/core/factorisations.hpp"
#include "datasets/core/se3.hpp"
#include "datasets/core/trajectory.hpp"

namespace loopbench {

/// Measured position of a point of the body at a keyframe.
struct Anchor {
  std::size_t keyframe = 0;
  Vector3 position = Vector3::Zero();        ///< in the world of the anchors [m]
  Matrix3 covariance = Matrix3::Identity();  ///< of `position`, axes of the world [m^2]
  Vector3 point_in_body = Vector3::Zero();   ///< measured point in the frame of the keyframe [m]
};

/// Position of the anchor's point for a pose of its keyframe, minus the measured position [m].
inline Vector3 anchor_error(const Anchor& anchor, const Pose& world_from_body) {
  return world_from_body.rotation * anchor.point_in_body + world_from_body.translation -
         anchor.position;
}

/// Squared Mahalanobis errors of the anchors, summed [-]. O(anchors).
inline double anchor_chi2(const std::vector<Anchor>& anchors, const Trajectory& keyframes) {
  double sum = 0.0;
  for (const Anchor& anchor : anchors) {
    const Vector3 e = anchor_error(anchor, keyframes[anchor.keyframe].world_from_body);
    sum += e.dot(anchor.covariance.llt().solve(e));
  }
  return sum;
}

/// Throws InputError with `name` and the violated rule: anchors refer to existing keyframes, are
/// sorted by keyframe, and their covariances are symmetric and positive definite. O(anchors).
inline void check(const std::vector<Anchor>& anchors,
                  std::size_t keyframes,
                  const std::string& name) {
  for (std::size_t i = 0; i < anchors.size(); ++i) {
    const Anchor& anchor = anchors[i];
    const auto invalid = [&](const std::string& what) {
      return InputError(name + ": anchor " + std::to_string(i) + ": " + what);
    };
    if (anchor.keyframe >= keyframes) throw invalid("refers to a keyframe that does not exist");
    if (i > 0 && anchor.keyframe < anchors[i - 1].keyframe) {
      throw invalid("is not sorted by keyframe");
    }
    if (!anchor.position.allFinite() || !anchor.point_in_body.allFinite() ||
        !anchor.covariance.allFinite()) {
      throw invalid("is not finite");
    }
    const Matrix3 skew = anchor.covariance - anchor.covariance.transpose();
    if (skew.cwiseAbs().maxCoeff() > 1e-9 * anchor.covariance.cwiseAbs().maxCoeff()) {
      throw invalid("covariance is not symmetric");
    }
    if (anchor.covariance.llt().info() != Eigen::Success) {
      throw invalid("covariance is not positive definite");
    }
  }
}

}  // namespace loopbench

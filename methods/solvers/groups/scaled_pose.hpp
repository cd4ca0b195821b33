/// A similarity transform of space: a pose and a scale.
#pragma once

#include "datasets/core/problem.hpp"

namespace loopbench::methods {

/// x -> scale R x + t. A scale of 1 makes it a rigid motion.
struct ScaledPose {
  Pose pose;
  double scale = 1.0;

  ScaledPose inverse() const {
    const Rotation inverse_rotation = pose.rotation.conjugate();
    return {{inverse_rotation, (inverse_rotation * pose.translation) / -scale}, 1.0 / scale};
  }
};

inline ScaledPose operator*(const ScaledPose& a_from_b, const ScaledPose& b_from_c) {
  const Pose& a = a_from_b.pose;
  const Pose& b = b_from_c.pose;
  return {{a.rotation * b.rotation, a_from_b.scale * (a.rotation * b.translation) + a.translation},
          a_from_b.scale * b_from_c.scale};
}

inline ScaledPose normalized(ScaledPose x) {
  x.pose.rotation.normalize();
  return x;
}

/// Measured similarity transform of an edge.
/// Inverse variance of the logarithm of an edge's scale: as stated, otherwise that of
/// `scale_sigma`.
inline double scale_information(const Edge& edge, double scale_sigma) {
  return edge.scale_information > 0.0 ? edge.scale_information : 1.0 / (scale_sigma * scale_sigma);
}

inline ScaledPose measured(const Edge& edge) { return {edge.from_from_to, edge.scale}; }

}  // namespace loopbench::methods

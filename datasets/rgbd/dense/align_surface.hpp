/// Camera pose by alignment of depth surfaces (point-to-plane ICP).
#pragma once

#include <vector>

#include "datasets/core/se3.hpp"
#include "datasets/rgbd/dense/surface.hpp"
#include "datasets/rgbd/tracking/camera_pose.hpp"

namespace loopbench::rgbd {

struct PlacedSurface {
  const Surface* surface = nullptr;
  Pose world_from_surface;
};

/// Prior of a pose: information of the twist e in world_from_camera * exp(e).
struct PriorPose {
  Pose world_from_camera;
  Matrix6 information = Matrix6::Zero();
};

struct SurfaceAlignment {
  Pose world_from_camera;
  Matrix6 information = Matrix6::Zero();  ///< sum of surface and prior information
  double share = 0.0;         ///< share of points associated with a surface of the model [-]
  double residual_rms = 0.0;  ///< RMS of whitened distances; 1 if the noise model is correct
};

/// Aligns `surface` to all surfaces of `model` by point-to-plane ICP with projective association
/// (Chen and Medioni 1991; Izadi et al. 2011, KinectFusion), using every second pixel and row.
/// Starts at the prior, whose information constrains directions that the surfaces do not observe,
/// such as sliding along a wall. Distances are whitened with inverse_depth_sigma and weighted by
/// Huber's function. A point associated with several surfaces counts once, because their errors are
/// correlated. As in refine_pose(), the surface information is multiplied by
/// options.information_scale and divided by residual_rms^2 if that is above 1. O(steps * pixels *
/// model).
SurfaceAlignment align_surface(const Surface& surface,
                               const std::vector<PlacedSurface>& model,
                               const PriorPose& prior,
                               const PoseOptions& options);

}  // namespace loopbench::rgbd

/// Where a camera stands, from the surfaces it sees.
#pragma once

#include <vector>

#include "datasets/core/se3.hpp"
#include "datasets/rgbd/dense/surface.hpp"
#include "datasets/rgbd/tracking/camera_pose.hpp"

namespace loopbench {

struct PlacedSurface {
  const Surface* surface = nullptr;
  Pose world_from_surface;
};

/// What is known of a pose beforehand: information is of e in world_from_camera * exp(e).
struct PriorPose {
  Pose world_from_camera;
  Matrix6 information = Matrix6::Zero();
};

struct Alignment {
  Pose world_from_camera;
  Matrix6 information = Matrix6::Zero();  ///< of surfaces and prior together
  double share = 0.0;   ///< of the surface's points that lie on some surface of the model
  double spread = 0.0;  ///< rms of whitened distances; 1 as modelled
};

/// Point-to-plane ICP with projective association (Chen and Medioni 1991; Izadi et al. 2011,
/// KinectFusion), every second pixel and row of `surface` against all of `model`, begun at the
/// prior and drawn to it by its information, so that a wall alone does not let the camera slide
/// along it. Distances are whitened by the surface's inverse_depth_sigma, Huber's weights. A point
/// that several surfaces show counts once: their errors are mostly the same. Its share of
/// information is divided by spread^2 when that is above 1, times options.information_scale, as
/// refine_pose() has it. O(steps * pixels * model).
Alignment align_surface(const Surface& surface,
                        const std::vector<PlacedSurface>& model,
                        const PriorPose& prior,
                        const PoseOptions& options);

}  // namespace loopbench

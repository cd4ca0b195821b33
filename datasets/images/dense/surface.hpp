/// Depth images as surfaces, points with normals, and their alignment (point-to-plane ICP).
#pragma once

#include <vector>

#include "datasets/core/se3.hpp"
#include "datasets/images/frames/camera.hpp"
#include "datasets/images/frames/image.hpp"

namespace loopbench::rgbd {

/// A downsampled, undistorted depth image with its pinhole camera.
struct DownsampledDepth {
  Camera camera;
  DepthImage depth;
  int block = 1;  ///< side of the block averaged to one pixel [px]
};

/// Undistorts and downsamples a depth image to at most `width` columns. Each pixel is the mean of
/// the depths within 2 % of the median of its block; 0 if less than half of the block has a depth
/// below depth_max [m]. O(pixels).
DownsampledDepth downsample_depth(const DepthImage& depth,
                                  const Camera& camera,
                                  int width,
                                  double depth_max);

/// Points and normals of all pixels in row-major order, in camera axes.
struct Surface {
  Camera camera;
  std::vector<Eigen::Vector3f> points;   ///< [m]; zero: not measured
  std::vector<Eigen::Vector3f> normals;  ///< towards the camera; zero: none
  double inverse_depth_sigma = 0.0;  ///< standard deviation of the inverse depth of a point [1/m]
};

/// Computes points and normals. A normal is that of the least-squares plane of 5 x 5 pixels. Pixels
/// next to depth edges, on curved patches (beyond noise) and at grazing angles have no normal.
/// Pixels of the original image have the noise kInverseDepthSigma; that of neighbouring pixels is
/// assumed independent. O(pixels).
Surface surface_of(const DownsampledDepth& image);

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
/// such as sliding along a wall. Distances are whitened with the noise of the inverse depth and
/// weighted by Huber's function. A point associated with several surfaces counts once, because
/// their errors are correlated. As in refine_pose(), the surface information is multiplied by
/// kInformationScale and divided by residual_rms^2 if that is above 1. O(steps * pixels *
/// model).
SurfaceAlignment align_surface(const Surface& surface,
                               const std::vector<PlacedSurface>& model,
                               const PriorPose& prior);

}  // namespace loopbench::rgbd

/// Depth images as surfaces: points with normals.
#pragma once

#include <vector>

#include "datasets/rgbd/camera.hpp"
#include "datasets/rgbd/image.hpp"

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
/// `inverse_depth_sigma` [1/m] is the standard deviation of one pixel of the original image; noise
/// of neighbouring pixels is assumed independent. O(pixels).
Surface surface_of(const DownsampledDepth& image, double inverse_depth_sigma);

}  // namespace loopbench::rgbd

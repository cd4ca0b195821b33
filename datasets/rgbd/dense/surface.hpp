/// What a depth image shows, as points with normals.
#pragma once

#include <vector>

#include "datasets/rgbd/camera.hpp"
#include "datasets/rgbd/image.hpp"

namespace loopbench {

/// A depth image made smaller, and the pinhole camera without distortion that would have taken it.
struct SmallDepth {
  Camera camera;
  DepthImage depth;
  int block = 1;  ///< pixels to each side that were made one
};

/// At most `width` columns: each pixel the mean of the block it stands for, of what lies within 2 %
/// of the block's median; none where less than half of the block was measured, or is deeper than
/// depth_max [m]. Lens distortion is undone. O(pixels).
SmallDepth small_depth(const DepthImage& depth, const Camera& camera, int width, double depth_max);

/// Points and normals of the pixels, row after row, in the camera's axes.
struct Surface {
  Camera camera;
  std::vector<Eigen::Vector3f> points;   ///< [m]; zero: not measured
  std::vector<Eigen::Vector3f> normals;  ///< towards the camera; zero: none
  double inverse_depth_sigma = 0.0;      ///< of a point [1/m]: averaged pixels are surer than one
};

/// Normals are those of the plane that fits 5 x 5 pixels best. None beside edges of depth, where
/// the pixels bend more than a plane may and more than noise explains, or where the surface is seen
/// at a grazing angle. `inverse_depth_sigma` [1/m] is of a pixel before any were averaged; noise of
/// neighbours is taken to be independent. O(pixels).
Surface surface_of(const SmallDepth& image, double inverse_depth_sigma);

}  // namespace loopbench

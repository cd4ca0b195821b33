/// From a scene and a camera to what a perfect camera would record.
#pragma once

#include "datasets/core/pose.hpp"
#include "datasets/rgbd/camera.hpp"
#include "datasets/rgbd/image.hpp"
#include "datasets/rgbd/render/scene.hpp"

namespace loopbench {

struct Rendered {
  Image<float> grey;   ///< 0..255
  DepthImage depth;    ///< every pixel [m]
  Image<float> slant;  ///< cosine of the angle at which the surface is seen
};

/// One ray a pixel, through its middle. O(pixels furniture).
Rendered render(const Scene& scene, const Camera& camera, const Pose& world_from_camera);

}  // namespace loopbench

/// Rendering of a scene without sensor noise.
#pragma once

#include "datasets/core/pose.hpp"
#include "datasets/rgbd/camera.hpp"
#include "datasets/rgbd/image.hpp"
#include "datasets/rgbd/render/scene.hpp"

namespace loopbench::rgbd {

struct RenderedImage {
  Image<float> grey;              ///< 0..255
  DepthImage depth;               ///< depth of every pixel [m]
  Image<float> incidence_cosine;  ///< cosine of the angle between ray and surface normal [-]
};

/// Casts one ray through the centre of each pixel. O(pixels * furniture).
RenderedImage render(const Scene& scene, const Camera& camera, const Pose& world_from_camera);

}  // namespace loopbench::rgbd

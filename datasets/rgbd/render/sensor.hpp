/// Noise model of a consumer RGB-D sensor.
#pragma once

#include <cstdint>

#include "datasets/core/pose.hpp"
#include "datasets/rgbd/camera.hpp"
#include "datasets/rgbd/image.hpp"
#include "datasets/rgbd/render/rendered_room.hpp"
#include "datasets/rgbd/render/scene.hpp"

namespace loopbench::rgbd {

/// Applies sensor effects to an ideal image.
/// Grey image: motion blur over the exposure (`begin_from_end` is the camera motion during it),
/// vignetting, a gain that varies slowly in time, noise and rounding.
/// Depth image: noise with standard deviation 1.425 mm/m^2 z^2 (Khoshelham and Elberink 2012),
/// disparity in steps of 1/8 pixel, rounding to millimetres and a random offset of at most one
/// pixel. Depth is missing below 0.5 m, above 4.5 m, on slanted surfaces, in the projector's shadow
/// next to depth edges and in random patches.
/// All draws are determined by `frame` and the seed. O(pixels).
RgbdFrame apply_sensor_model(const RenderedImage& ideal,
                             const Camera& camera,
                             const Pose& begin_from_end,
                             double stamp,
                             std::uint64_t frame,
                             const RenderOptions& options);

}  // namespace loopbench::rgbd

/// What a cheap RGB-D sensor makes of a perfect image.
#pragma once

#include <cstdint>

#include "datasets/core/pose.hpp"
#include "datasets/rgbd/camera.hpp"
#include "datasets/rgbd/image.hpp"
#include "datasets/rgbd/render/render.hpp"
#include "datasets/rgbd/render/render_options.hpp"

namespace loopbench {

/// Grey: smeared along the motion of the camera during the exposure (`begin_from_end`: where the
/// camera stands at its end, seen from its beginning), darkened to the corners, brightened by a
/// gain that comes and goes in time, noisy, rounded.
/// Depth: standard deviation 1.425 mm/m^2 z^2 (Khoshelham and Elberink 2012), disparity in eighths
/// of a pixel, millimetres, a pixel's jitter sideways; none nearer than 0.5 m or farther than
/// 4.5 m, at slanting surfaces, beside depth edges (the projector's shadow) and in random patches.
/// `frame` and the seed fix every draw. O(pixels).
RgbdFrame sensed(const Rendered& perfect,
                 const Camera& camera,
                 const Pose& begin_from_end,
                 double stamp,
                 std::uint64_t frame,
                 const RenderOptions& options);

}  // namespace loopbench

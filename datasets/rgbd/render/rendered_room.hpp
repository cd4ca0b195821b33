/// A camera carried once around a room that does not exist: images without a download.
#pragma once

#include <memory>

#include "datasets/rgbd/render/render_options.hpp"
#include "datasets/rgbd/rgbd_source.hpp"

namespace loopbench {

/// The path is the simulated `room` (datasets/simulated/path.hpp), the camera looks along the
/// body's x axis with a horizontal field of view of 62 degrees. Frames lie at k / rate. The
/// reference is the camera's true pose at four times the rate. Nothing is kept but the room: each
/// frame is rendered when it is read.
std::unique_ptr<const RgbdSource> rendered_room(const RenderOptions& options);

}  // namespace loopbench

/// Frame source that renders a hand-held camera in a synthetic room, without downloads.
#pragma once

#include <memory>

#include "datasets/rgbd/render/render_options.hpp"
#include "datasets/rgbd/rgbd_source.hpp"

namespace loopbench::rgbd {

/// The camera follows the simulated path `room` (datasets/simulated/path.hpp) and looks along the x
/// axis of the body, with a horizontal field of view of 62 degrees. Frames have stamps k / rate.
/// The reference contains the true camera poses at four times this rate. Frames are rendered when
/// they are read.
std::unique_ptr<const RgbdSource> rendered_room(const RenderOptions& options);

}  // namespace loopbench::rgbd

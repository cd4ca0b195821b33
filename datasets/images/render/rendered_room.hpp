/// Frame source that renders a hand-held camera in a synthetic room, without downloads.
#pragma once

#include <cstdint>
#include <memory>

#include "datasets/core/fields.hpp"
#include "datasets/images/frames/rgbd_source.hpp"

namespace loopbench::rgbd {

/// Scene, camera motion and sensor noise.
struct RenderOptions {
  std::int64_t seed = 1;
  std::int64_t width = 320;
  double rate = 8.0;
  double laps = 1.06;
  double depth_noise = 1.0;  ///< relative to a Kinect [-]
  double dropouts = 1.0;     ///< relative to a Kinect [-]
};

template <class Visit>
void fields(RenderOptions& o, Visit visit) {
  visit("seed", o.seed, "random seed of room, textures and noise", Between{0});
  visit("width", o.width, "image width [px]; the height is 3/4 of it", Between{64, 1920});
  visit("rate", o.rate, "frame rate of the camera [Hz]", Between{0.1, 120});
  visit("laps", o.laps, "number of laps around the room", Between{0.001, 100});
  visit("depth_noise",
        o.depth_noise,
        "depth noise relative to a Kinect (1.4 mm/m^2) [-]",
        Between{0, 20});
  visit("dropouts", o.dropouts, "rate of missing depth relative to a Kinect [-]", Between{0, 20});
}

/// The camera follows the simulated path `room` (datasets/simulated/path.hpp) and looks along the x
/// axis of the body, with a horizontal field of view of 62 degrees. Frames have stamps k / rate.
/// The reference contains the true camera poses at four times this rate. Frames are rendered when
/// they are read.
std::unique_ptr<const RgbdSource> rendered_room(const RenderOptions& options);

}  // namespace loopbench::rgbd

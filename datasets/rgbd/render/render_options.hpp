/// Settings of the rendered room: what is seen, and what the sensor makes of it.
#pragma once

#include <cstdint>

#include "datasets/core/fields.hpp"

namespace loopbench {

struct RenderOptions {
  std::int64_t seed = 1;
  std::int64_t width = 320;
  double rate = 8.0;
  double laps = 1.06;
  double blur = 0.012;       ///< exposure time [s]
  double noise = 3.0;        ///< [grey levels]
  double exposure = 0.25;    ///< slow change of brightness [-]
  double depth_noise = 1.0;  ///< times the Kinect's
  double dropouts = 1.0;     ///< times the Kinect's
};

template <class Visit>
void fields(RenderOptions& o, Visit visit) {
  visit("seed", o.seed, "of room, textures and noise", Between{0});
  visit("width", o.width, "of the images [px]; height is three quarters of it", Between{64, 1920});
  visit("rate", o.rate, "of the camera [Hz]", Between{0.1, 120});
  visit("laps", o.laps, "how often round the room", Between{0.001, 100});
  visit("blur", o.blur, "exposure time that motion smears over [s]", Between{0, 0.1});
  visit("noise", o.noise, "of grey values [levels]", Between{0, 50});
  visit("exposure", o.exposure, "share by which brightness comes and goes [-]", Between{0, 0.8});
  visit("depth_noise", o.depth_noise, "times a Kinect's 1.4 mm/m^2 [-]", Between{0, 20});
  visit("dropouts", o.dropouts, "holes in depth, times a Kinect's [-]", Between{0, 20});
}

}  // namespace loopbench

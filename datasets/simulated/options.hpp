/// Settings of the simulated dataset.
#pragma once

#include <cstdint>

#include "datasets/core/fields.hpp"
#include "datasets/noise_stream.hpp"

namespace loopbench {

enum class SimulatedPath { room, office, driving, line, still, spin };
inline auto choices(SimulatedPath) {
  return std::array{std::pair{"room", SimulatedPath::room},
                    std::pair{"office", SimulatedPath::office},
                    std::pair{"driving", SimulatedPath::driving},
                    std::pair{"line", SimulatedPath::line},
                    std::pair{"still", SimulatedPath::still},
                    std::pair{"spin", SimulatedPath::spin}};
}

/// variance of a step = gain^2 * (per_second dt + per_metre d + per_radian |dtheta| +
/// per_speed (d / dt)^2 dt), on each of the three axes.
struct StepVariance {
  double per_second;  ///< [unit^2/s]
  double per_metre;   ///< [unit^2/m]
  double per_radian;  ///< [unit^2/rad]
  double per_speed;   ///< [unit^2 s/m^2]
};

/// Defaults: `room` drifts like open ORB-SLAM2 on fr1_room (ATE about 0.1 m), `driving` by metres.
struct OdometryNoise {
  double gain = 1.0;  ///< on every standard deviation [-]
  StepVariance translation{1e-4, 1.5e-3, 2e-4, 0.0};
  StepVariance rotation{5e-6, 1e-6, 6e-5, 0.0};
};

/// The same in every run: what a badly calibrated sensor does. Not in any edge's information.
struct SystematicDrift {
  double scale = 0.0;             ///< too long by this share along the motion [-]
  double yaw_per_second = 0.0;    ///< about the body's z axis [rad/s]
  double yaw_per_metre = 0.0;     ///< [rad/m]
  double yaw_per_radian = 0.0;    ///< of turn either way [rad/rad]
  double pitch_per_second = 0.0;  ///< about the body's y axis [rad/s]
  double pitch_per_metre = 0.0;   ///< [rad/m]
  double pitch_per_radian = 0.0;  ///< of turn either way [rad/rad]
};

/// White noise on every tracked frame, keyframes among them: what smoothing can remove. Odometry is
/// measured without it.
struct Shake {
  double sigma_t = 0.0;  ///< [m]
  double sigma_r = 0.0;  ///< [rad]
};

struct SimulatedClosures {
  double radius = 0.0;       ///< [m]; 0: the path's own
  double angle = 30.0;       ///< [deg]
  double min_gap = 10.0;     ///< [s]
  std::int64_t max = 10;     ///< true ones kept
  double sigma_t = 0.02;     ///< [m]
  double sigma_r = 0.005;    ///< [rad]
  double false_share = 0.0;  ///< of all closures [-]
};

struct SimulatedOptions {
  SimulatedPath path = SimulatedPath::room;
  std::int64_t seed = 1;
  std::string stream;  ///< shared noise; empty: noise of its own
  std::int64_t laps = 1;
  std::int64_t keyframes = 0;
  double frame_rate = 0.0;
  double reference_rate = 0.0;
  bool planar = false;
  OdometryNoise noise;
  SystematicDrift drift;
  Shake shake;
  SimulatedClosures closures;
};

template <class Visit>
void fields(SimulatedOptions& o, Visit visit) {
  visit("path", o.path, "closed-form path to follow");
  visit("seed", o.seed, "seed of all random draws", Between{0});
  noise_stream_field(o.stream, visit);
  visit("laps", o.laps, "how often the path is run through", Between{1});
  visit("keyframes", o.keyframes, "how many, evenly in time; 0: the path's own a lap", Between{0});
  visit("frame_rate", o.frame_rate, "of tracked frames [Hz]; 0: the path's own", Between{0, 1e4});
  visit("reference_rate", o.reference_rate, "[Hz]; 0: four times frame_rate", Between{0, 1e5});
  visit("planar", o.planar, "flatten path and noise to SE(2)");

  OdometryNoise& n = o.noise;
  const Between variance{0, 1};
  visit("noise.gain", n.gain, "on all odometry standard deviations [-]", Between{0, 1e3});
  visit("noise.t.per_second", n.translation.per_second, "variance a step [m^2/s]", variance);
  visit("noise.t.per_metre", n.translation.per_metre, "variance a step [m^2/m]", variance);
  visit("noise.t.per_radian", n.translation.per_radian, "variance a step [m^2/rad]", variance);
  visit("noise.t.per_speed", n.translation.per_speed, "times speed^2 dt [m^2 s/m^2]", variance);
  visit("noise.r.per_second", n.rotation.per_second, "variance a step [rad^2/s]", variance);
  visit("noise.r.per_metre", n.rotation.per_metre, "variance a step [rad^2/m]", variance);
  visit("noise.r.per_radian", n.rotation.per_radian, "variance a step [rad^2/rad]", variance);
  visit("noise.r.per_speed", n.rotation.per_speed, "times speed^2 dt [rad^2 s/m^2]", variance);

  SystematicDrift& d = o.drift;
  const Between some{-1, 1};
  visit("drift.scale", d.scale, "odometry too long by this share [-]", Between{-0.9, 9});
  visit("drift.yaw_per_second", d.yaw_per_second, "steady turn about body z [rad/s]", some);
  visit("drift.yaw_per_metre", d.yaw_per_metre, "turn about body z [rad/m]", some);
  visit("drift.yaw_per_radian", d.yaw_per_radian, "turn about body z [rad/rad]", some);
  visit("drift.pitch_per_second", d.pitch_per_second, "steady turn about body y [rad/s]", some);
  visit("drift.pitch_per_metre", d.pitch_per_metre, "turn about body y [rad/m]", some);
  visit("drift.pitch_per_radian", d.pitch_per_radian, "turn about body y [rad/rad]", some);

  visit("shake.sigma_t", o.shake.sigma_t, "white noise on every frame [m]", Between{0, 1e3});
  visit("shake.sigma_r", o.shake.sigma_r, "white noise on every frame [rad]", Between{0, 1});

  SimulatedClosures& c = o.closures;
  visit(
      "closures.radius", c.radius, "how near a revisit is [m]; 0: the path's own", Between{0, 1e6});
  visit("closures.angle", c.angle, "how alike a revisit looks [deg]", Between{0, 180});
  visit("closures.min_gap", c.min_gap, "shortest loop [s]", Above{0});
  visit("closures.max", c.max, "true closures kept, well spread", Between{0});
  visit("closures.sigma_t", c.sigma_t, "noise [m]", Between{0, 1e3});
  visit("closures.sigma_r", c.sigma_r, "noise [rad]", Between{0, 1});
  visit("closures.false_share", c.false_share, "false ones among all [-]", Between{0, 0.95});
}

/// Throws OptionError for options of which one disables another.
void check_combination(const SimulatedOptions& options);

/// Where all noise of the dataset comes from. Datasets that differ in any option but the seed draw
/// independent noise, unless they name the same `stream`.
NoiseStream noise_stream(const SimulatedOptions& options);

/// The same in words: datasets with equal text share their noise.
std::string noise_text(const SimulatedOptions& options);

}  // namespace loopbench

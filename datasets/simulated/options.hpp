/// Options of the simulated dataset.
#pragma once

#include <cstdint>

#include "datasets/core/fields.hpp"
#include "datasets/noise/noise_stream.hpp"

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

/// Variance of a step = gain^2 * (per_second dt + per_metre d + per_radian |dtheta| +
/// per_speed (d / dt)^2 dt), on each of the three axes.
struct StepVariance {
  double per_second;  ///< [unit^2/s]
  double per_metre;   ///< [unit^2/m]
  double per_radian;  ///< [unit^2/rad]
  double per_speed;   ///< [unit^2 s/m^2]
};

/// With the defaults `room` drifts like ORB-SLAM2 without loop closing on fr1_room (ATE about 0.1
/// m), and `driving` by several metres.
struct OdometryNoise {
  double gain = 1.0;   ///< factor on every standard deviation [-]
  bool level = false;  ///< errors of rotation, also systematic ones, are about the vertical alone
  StepVariance translation{1e-4, 1.5e-3, 2e-4, 0.0};
  StepVariance rotation{5e-6, 1e-6, 6e-5, 0.0};
};

/// Deterministic errors, as of a badly calibrated sensor. Not included in the information of edges.
struct SystematicDrift {
  double scale = 0.0;             ///< relative scale error of translations [-]
  double yaw_per_second = 0.0;    ///< about the body's z axis [rad/s]
  double yaw_per_metre = 0.0;     ///< [rad/m]
  double yaw_per_radian = 0.0;    ///< per rotation angle of any sign [rad/rad]
  double pitch_per_second = 0.0;  ///< about the body's y axis [rad/s]
  double pitch_per_metre = 0.0;   ///< [rad/m]
  double pitch_per_radian = 0.0;  ///< per rotation angle of any sign [rad/rad]
};

/// White noise on every tracked frame, including keyframes, which smoothing can remove. Odometry
/// edges do not contain it.
struct WhiteNoise {
  double sigma_t = 0.0;  ///< [m]
  double sigma_r = 0.0;  ///< [rad]
};

struct SimulatedClosures {
  double radius = 0.0;       ///< [m]; 0: default of the path
  double angle = 30.0;       ///< [deg]
  double min_gap = 10.0;     ///< [s]
  std::int64_t max = 10;     ///< maximum number of true closures
  double sigma_t = 0.02;     ///< [m]
  double sigma_r = 0.005;    ///< [rad]
  double false_share = 0.0;  ///< false closures among all closures [-]
};

/// Measured positions of keyframes, drawn at random.
struct SimulatedAnchors {
  std::int64_t count = 0;
  double sigma = 0.02;  ///< [m]
};

struct SimulatedOptions {
  SimulatedPath path = SimulatedPath::room;
  std::int64_t seed = 1;
  std::string stream;  ///< name of a shared noise stream; empty: own stream
  std::int64_t laps = 1;
  std::int64_t keyframes = 0;
  double frame_rate = 0.0;
  double reference_rate = 0.0;
  bool planar = false;
  OdometryNoise noise;
  SystematicDrift drift;
  WhiteNoise white_noise;
  SimulatedClosures closures;
  SimulatedAnchors anchors;
};

template <class Visit>
void fields(SimulatedOptions& o, Visit visit) {
  visit("path",
        o.path,
        "path; room, office: hand-held loops; driving: 1 km through town blocks; line: straight; "
        "still: at rest; spin: rotation at one position");
  visit("seed", o.seed, "seed of all random draws", Between{0});
  noise_stream_field(o.stream, visit);
  visit("laps", o.laps, "number of laps along the path", Between{1});
  visit("keyframes",
        o.keyframes,
        "number of keyframes, evenly spaced in time; 0: default of the path, per lap",
        Between{0});
  visit("frame_rate",
        o.frame_rate,
        "rate of tracked frames [Hz]; 0: default of the path",
        Between{0, 1e4});
  visit("reference_rate",
        o.reference_rate,
        "rate of reference poses [Hz]; 0: four times frame_rate",
        Between{0, 1e5});
  visit("planar", o.planar, "restriction of path and noise to SE(2)");

  OdometryNoise& n = o.noise;
  const Between variance{0, 1};
  visit("noise.gain", n.gain, "factor on all odometry standard deviations [-]", Between{0, 1e3});
  visit("noise.level",
        n.level,
        "rotation errors of odometry about the vertical only, as with an IMU: roll and pitch are "
        "exact; stated deviations are those of all axes");
  visit("noise.t.per_second",
        n.translation.per_second,
        "translation variance per time [m^2/s]",
        variance);
  visit("noise.t.per_metre",
        n.translation.per_metre,
        "translation variance per distance travelled [m^2/m]",
        variance);
  visit("noise.t.per_radian",
        n.translation.per_radian,
        "translation variance per rotation angle [m^2/rad]",
        variance);
  visit("noise.t.per_speed",
        n.translation.per_speed,
        "translation variance per squared speed and time [m^2 s/m^2]",
        variance);
  visit("noise.r.per_second",
        n.rotation.per_second,
        "rotation variance per time [rad^2/s]",
        variance);
  visit("noise.r.per_metre",
        n.rotation.per_metre,
        "rotation variance per distance travelled [rad^2/m]",
        variance);
  visit("noise.r.per_radian",
        n.rotation.per_radian,
        "rotation variance per rotation angle [rad^2/rad]",
        variance);
  visit("noise.r.per_speed",
        n.rotation.per_speed,
        "rotation variance per squared speed and time [rad^2 s/m^2]",
        variance);

  SystematicDrift& d = o.drift;
  const Between some{-1, 1};
  visit("drift.scale",
        d.scale,
        "relative scale error of odometry translations [-]",
        Between{-0.9, 9});
  visit("drift.yaw_per_second",
        d.yaw_per_second,
        "systematic yaw error per time, about body z [rad/s]",
        some);
  visit("drift.yaw_per_metre",
        d.yaw_per_metre,
        "systematic yaw error per distance travelled [rad/m]",
        some);
  visit("drift.yaw_per_radian",
        d.yaw_per_radian,
        "systematic yaw error per rotation angle [rad/rad]",
        some);
  visit("drift.pitch_per_second",
        d.pitch_per_second,
        "systematic pitch error per time, about body y [rad/s]",
        some);
  visit("drift.pitch_per_metre",
        d.pitch_per_metre,
        "systematic pitch error per distance travelled [rad/m]",
        some);
  visit("drift.pitch_per_radian",
        d.pitch_per_radian,
        "systematic pitch error per rotation angle [rad/rad]",
        some);

  visit("white_noise.sigma_t",
        o.white_noise.sigma_t,
        "standard deviation of white position noise on every frame [m]",
        Between{0, 1e3});
  visit("white_noise.sigma_r",
        o.white_noise.sigma_r,
        "standard deviation of white rotation noise on every frame [rad]",
        Between{0, 1});

  SimulatedClosures& c = o.closures;
  visit("closures.radius",
        c.radius,
        "maximum distance between the two poses of a revisit [m]; 0: default of the path",
        Between{0, 1e6});
  visit("closures.angle",
        c.angle,
        "maximum rotation angle between the two poses of a revisit [deg]",
        Between{0, 180});
  visit("closures.min_gap",
        c.min_gap,
        "minimum time between the two poses of a revisit [s]",
        GreaterThan{0});
  visit("closures.max", c.max, "maximum number of true closures, subsampled evenly", Between{0});
  visit("closures.sigma_t",
        c.sigma_t,
        "translation standard deviation of a closure [m]",
        Between{0, 1e3});
  visit("closures.sigma_r",
        c.sigma_r,
        "rotation standard deviation of a closure [rad]",
        Between{0, 1});
  visit("closures.false_share",
        c.false_share,
        "share of false closures among all closures [-]",
        Between{0, 0.95});

  visit("anchors.count",
        o.anchors.count,
        "number of measured positions, at keyframes drawn at random",
        Between{0, 1'000'000});
  visit("anchors.sigma",
        o.anchors.sigma,
        "standard deviation of each coordinate of a measured position [m]",
        Between{0, 1e3});
}

/// Throws OptionError if an option has no effect or is invalid because of another option.
void check_combination(const SimulatedOptions& options);

/// Random stream of all noise of the dataset. Datasets that differ in any option other than the
/// seed draw independent noise, unless they have the same `stream`.
NoiseStream noise_stream(const SimulatedOptions& options);

/// Description of the stream for provenance: datasets with equal text share their noise.
std::string noise_text(const SimulatedOptions& options);

}  // namespace loopbench

/// The dataset `trajectory`: a problem derived from an estimate file of any known format.
#pragma once

#include "datasets/dataset.hpp"
#include "datasets/derive/closure_file.hpp"
#include "datasets/derive/closures.hpp"
#include "datasets/derive/false_closures.hpp"
#include "datasets/derive/keyframes.hpp"
#include "datasets/derive/odometry.hpp"
#include "datasets/derive/reference_body.hpp"
#include "datasets/formats/formats.hpp"

namespace loopbench {

enum class ClosureSource { none, file, reference, estimate };
inline auto choices(ClosureSource) {
  return std::array{std::pair{"none", ClosureSource::none},
                    std::pair{"file", ClosureSource::file},
                    std::pair{"reference", ClosureSource::reference},
                    std::pair{"estimate", ClosureSource::estimate}};
}

enum class ClosureScale { same, local };
inline auto choices(ClosureScale) {
  return std::array{std::pair{"same", ClosureScale::same}, std::pair{"local", ClosureScale::local}};
}

/// Estimate and other run must describe the same body: two runs on the same camera do, a camera and
/// an IMU do not. So must the reference, unless `reference_body` says where its own is. TUM and
/// KITTI files are camera poses throughout.
struct TrajectoryOptions {
  std::string name;
  std::string estimate;
  std::string reference;
  ReferenceBody reference_body;
  std::string frames;
  Format format = Format::automatic;
  Format reference_format = Format::automatic;
  std::string times;
  double period = 0.1;
  Repeats repeats = Repeats::refuse;
  KeyframeChoice keyframes;
  EdgeNoise odometry;
  ClosureSource closures = ClosureSource::none;
  std::string closures_file;
  double closures_radius = 0.5;
  double closures_angle = 30.0;  ///< [deg]
  double closures_min_gap = 5.0;
  std::int64_t closures_max = 20;
  ClosureScale closures_scale = ClosureScale::same;
  ClosureNoise closures_noise;
  Reach reach;
  FalseClosures false_closures;
  std::int64_t seed = 1;
  std::string stream;  ///< shared noise; empty: noise of its own
  std::string sensor;
  std::string licence;
};

template <class Visit>
void fields(TrajectoryOptions& o, Visit visit) {
  visit("name", o.name, "of the sequence; empty: folder and stem of the estimate");
  visit("estimate", o.estimate, "file with the drifting (or corrected) poses");
  visit("reference", o.reference, "file with the reference; empty: none");
  reference_body_fields(o.reference_body, visit);
  visit("frames", o.frames, "frames of the same run, when the estimate is a keyframe file");
  visit("format", o.format, "of estimate, frames and closures.file");
  visit("reference_format", o.reference_format, "of the reference");
  visit("times", o.times, "times file of KITTI poses, one stamp [s] a line");
  visit("period", o.period, "between poses without stamps [s]", Above{0.0});
  visit("repeats", o.repeats, "what to do with a pose whose stamp repeats the last one");
  visit("keyframes.rule", o.keyframes.rule, "which poses of the estimate are keyframes");
  visit("keyframes.value",
        o.keyframes.value,
        "every k poses, or least distance [s] or [m], or how many",
        Above{0.0});
  visit("odometry.sigma_t",
        o.odometry.sigma_t,
        "assumed standard deviation of an edge at rest [m]",
        Above{0.0});
  visit("odometry.sigma_r",
        o.odometry.sigma_r,
        "assumed standard deviation of an edge at rest [rad]",
        Above{0.0});
  const Between any{0.0, 1e6};
  visit("odometry.sigma_t_per_m",
        o.odometry.sigma_t_per_m,
        "assumed growth with the square root of distance travelled [m/sqrt(m)]",
        any);
  visit("odometry.sigma_r_per_m",
        o.odometry.sigma_r_per_m,
        "assumed growth with the square root of distance travelled [rad/sqrt(m)]",
        any);
  visit("odometry.sigma_t_per_rad",
        o.odometry.sigma_t_per_rad,
        "assumed growth with the square root of the rotation angle [m/sqrt(rad)]",
        any);
  visit("odometry.sigma_r_per_rad",
        o.odometry.sigma_r_per_rad,
        "assumed growth with the square root of the rotation angle [rad/sqrt(rad)]",
        any);
  visit("closures.source", o.closures, "file: a list; reference: oracle; estimate: another run");
  visit("closures.file", o.closures_file, "list of closures, or estimate of the other run");
  visit("closures.radius", o.closures_radius, "largest distance of a revisit [m]", Above{0.0});
  visit("closures.angle", o.closures_angle, "largest turn of a revisit [deg]", Between{0.0, 180.0});
  visit("closures.min_gap", o.closures_min_gap, "least time to a revisit [s]", Above{0.0});
  visit("closures.max", o.closures_max, "at most so many, well spread; 0: all", Between{0});
  visit("closures.scale",
        o.closures_scale,
        "of another run; same: as the estimate's; local: monocular, closures are of Sim(3)");
  visit("closures.sigma_t", o.closures_noise.sigma_t, "of a closure [m]", Above{0.0});
  visit("closures.sigma_r", o.closures_noise.sigma_r, "of a closure [rad]", Above{0.0});
  visit(
      "closures.max_diff", o.reach.max_diff, "between stamps taken as one [s]", Between{0.0, 1e9});
  visit("closures.max_interval",
        o.reach.max_gap,
        "longest gap interpolated in reference or other run [s]",
        Between{0.0, 1e9});
  false_closure_fields(o.false_closures, visit);
  visit("seed", o.seed, "seed of the noise on closures from the reference");
  noise_stream_field(o.stream, visit);
  visit("sensor", o.sensor, "free text for the results");
  visit("licence", o.licence, "of the data, free text for the results");
}

/// Files that are needed are named, and no option is `given` that another one disables. Throws
/// OptionError that names both.
void check_combination(const TrajectoryOptions& options, const Params& given);

/// The files' content, read.
struct TrajectoryInputs {
  Trajectory estimate;
  Trajectory frames;     ///< empty: poses of the estimate that are no keyframes stand in
  Trajectory reference;  ///< may be empty
  Trajectory other_run;  ///< for closures.source estimate
  std::vector<TimedClosure> closures;  ///< for closures.source file
};

/// Loop endpoints named in a closure file become keyframes whatever the rule. Closures from the
/// reference carry seeded noise; those from another run are that run's measurement as it is. A run
/// of another scale (path lengths differ by a quarter or more: monocular) is refused, or with
/// closures.scale local gives closures of Sim(3) (with_local_scale); closures.radius is in its
/// unit. `false_closures`, if any, receives how many were added. Throws OptionError, InputError.
/// O(n log n).
Problem derive_problem(const TrajectoryInputs& inputs,
                       const TrajectoryOptions& options,
                       std::size_t* false_closures = nullptr);

/// Throws OptionError, InputError.
Sequence load_trajectory(const TrajectoryOptions& options, const DataRoot& root);

}  // namespace loopbench

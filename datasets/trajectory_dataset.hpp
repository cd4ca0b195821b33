/// The dataset `trajectory`: a problem derived from an estimated trajectory in any known format.
#pragma once

#include "datasets/dataset.hpp"
#include "datasets/derive/anchors.hpp"
#include "datasets/derive/closures.hpp"
#include "datasets/derive/false_closures.hpp"
#include "datasets/derive/keyframes.hpp"
#include "datasets/derive/odometry.hpp"
#include "datasets/derive/planar.hpp"
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

/// Which keyframes see a place again: by distance and angle of the poses, or by the space in view.
enum class ClosureRule { distance, view };
inline auto choices(ClosureRule) {
  return std::array{std::pair{"distance", ClosureRule::distance},
                    std::pair{"view", ClosureRule::view}};
}

inline auto choices(View::Axes) {
  return std::array{std::pair{"z", View::Axes::z_forward}, std::pair{"x", View::Axes::x_forward}};
}

/// Field of view [deg] and range [m] of a Kinect.
struct ViewOptions {
  double horizontal = 57.0;
  double vertical = 43.0;
  double nearest = 0.8;
  double farthest = 4.0;
  double share = 0.5;
  View::Axes forward = View::Axes::z_forward;
};

template <class Visit>
void view_fields(ViewOptions& o, Visit visit) {
  visit("closures.view.horizontal",
        o.horizontal,
        "horizontal field of view of the sensor [deg]",
        Between{1.0, 360.0});
  visit("closures.view.vertical",
        o.vertical,
        "vertical field of view of the sensor [deg]",
        Between{1.0, 180.0});
  visit("closures.view.nearest", o.nearest, "least range of the sensor [m]", Between{0.0, 1e6});
  visit("closures.view.farthest", o.farthest, "largest range of the sensor [m]", GreaterThan{0.0});
  visit("closures.view.share",
        o.share,
        "least share of the view, by volume, that a revisit sees again [-]",
        Between{0.01, 1.0});
  visit("closures.view.forward",
        o.forward,
        "axis of the body along which the sensor looks; z: camera (y down); x: vehicle (z up)");
}

enum class ClosureScale { same, local };
inline auto choices(ClosureScale) {
  return std::array{std::pair{"same", ClosureScale::same}, std::pair{"local", ClosureScale::local}};
}

/// Estimate, other run and reference must contain poses of the same body, for example the same
/// camera. If the reference contains another body, `reference_body` gives its extrinsic offset. TUM
/// and KITTI files contain camera poses.
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
  bool sort = false;
  bool drop_invalid = false;
  StampUnit stamp_unit = StampUnit::automatic;
  double offset = 0.0;  ///< reference stamp - estimate stamp [s]
  KeyframeChoice keyframes;
  EdgeNoise odometry;
  std::string breaks;
  ClosureSource closures = ClosureSource::none;
  std::string closures_file;
  ClosureRule closures_rule = ClosureRule::distance;
  double closures_radius = 0.5;
  double closures_angle = 30.0;  ///< [deg]
  ViewOptions closures_view;
  double closures_min_gap = 5.0;
  std::int64_t closures_max = 20;
  ClosureScale closures_scale = ClosureScale::same;
  ClosureNoise closures_noise;
  InterpolationLimits reach;
  FalseClosures false_closures;
  std::string anchors_file;
  double anchors_sigma = 0.05;
  double anchors_max_gap = 1.0;
  Planar planar = Planar::automatic;
  std::int64_t seed = 1;
  std::string stream;  ///< name of a shared noise stream; empty: own stream
  std::string sensor;
  std::string licence;
};

template <class Visit>
void fields(TrajectoryOptions& o, Visit visit) {
  visit("name", o.name, "name of the sequence; empty: folder and file name of the estimate");
  visit("estimate", o.estimate, "file with the estimated poses, before or after loop closing");
  visit("reference", o.reference, "file with the reference (ground truth) poses; empty: none");
  reference_body_fields(o.reference_body, visit);
  visit("frames",
        o.frames,
        "file with all tracked poses of the same run, if the estimate contains only keyframes; "
        "empty: none");
  visit("format",
        o.format,
        "file format of estimate, frames and, for closures.source: estimate, closures.file");
  visit("reference_format", o.reference_format, "file format of the reference");
  visit("times",
        o.times,
        "file with the times of poses without stamps, one per line [s]; empty: use period");
  visit("period", o.period, "time between poses in formats without stamps [s]", GreaterThan{0.0});
  visit("repeats", o.repeats, "handling of a pose with the same stamp as the previous one");
  visit("sort", o.sort, "sort rows that are not in order of time");
  visit("drop_invalid",
        o.drop_invalid,
        "drop rows with numbers that are not finite, or zero quaternions");
  visit("stamp_unit", o.stamp_unit, "unit of stamps, if the file does not name it");
  visit("offset",
        o.offset,
        "time offset between the clocks: stamps of the reference are those of the estimate plus "
        "this [s]",
        Between{-1e10, 1e10});
  visit("keyframes.rule", o.keyframes.rule, "rule that selects keyframes from the estimate");
  visit("keyframes.value",
        o.keyframes.value,
        "parameter of keyframes.rule: interval [poses], minimum spacing [s] or [m], or number of "
        "keyframes",
        GreaterThan{0.0});
  visit("odometry.sigma_t",
        o.odometry.sigma_t,
        "assumed translation standard deviation of an odometry edge at rest [m]",
        GreaterThan{0.0});
  visit("odometry.sigma_r",
        o.odometry.sigma_r,
        "assumed rotation standard deviation of an odometry edge at rest [rad]",
        GreaterThan{0.0});
  const Between any{0.0, 1e6};
  visit("odometry.sigma_t_per_m",
        o.odometry.sigma_t_per_m,
        "assumed translation standard deviation per square root of distance travelled [m/sqrt(m)]",
        any);
  visit("odometry.sigma_r_per_m",
        o.odometry.sigma_r_per_m,
        "assumed rotation standard deviation per square root of distance travelled [rad/sqrt(m)]",
        any);
  visit("odometry.sigma_t_per_rad",
        o.odometry.sigma_t_per_rad,
        "assumed translation standard deviation per square root of rotation angle [m/sqrt(rad)]",
        any);
  visit("odometry.sigma_r_per_rad",
        o.odometry.sigma_r_per_rad,
        "assumed rotation standard deviation per square root of rotation angle [rad/sqrt(rad)]",
        any);
  visit("breaks",
        o.breaks,
        "stamps of poses at which the estimate starts again, separated by blanks [s]: the odometry "
        "that arrives there is of unknown motion; empty: none");
  visit("closures.source",
        o.closures,
        "source of loop closures; file: closure file; reference: measured in the reference with "
        "simulated noise; estimate: measured in another run");
  visit("closures.file",
        o.closures_file,
        "closure file, g2o graph of the poses (.g2o), or estimated trajectory of the other run");
  visit("closures.rule",
        o.closures_rule,
        "which keyframes see a place again; distance: at most closures.radius and closures.angle "
        "apart; view: they share closures.view.share of the sensor's field of view");
  visit("closures.radius",
        o.closures_radius,
        "maximum distance between the two poses of a revisit [m]",
        GreaterThan{0.0});
  visit("closures.angle",
        o.closures_angle,
        "maximum rotation angle between the two poses of a revisit [deg]",
        Between{0.0, 180.0});
  view_fields(o.closures_view, visit);
  visit("closures.min_gap",
        o.closures_min_gap,
        "minimum time between the two poses of a revisit [s]",
        GreaterThan{0.0});
  visit("closures.max",
        o.closures_max,
        "maximum number of closures, subsampled evenly over the sequence; 0: all",
        Between{0});
  visit("closures.scale",
        o.closures_scale,
        "scale of the other run; same: equal to the estimate's; local: estimated locally, giving "
        "Sim(3) closures (monocular)");
  visit("closures.sigma_t",
        o.closures_noise.sigma_t,
        "translation standard deviation of a closure [m]",
        GreaterThan{0.0});
  visit("closures.sigma_r",
        o.closures_noise.sigma_r,
        "rotation standard deviation of a closure [rad]",
        GreaterThan{0.0});
  visit("closures.max_diff",
        o.reach.max_diff,
        "maximum time difference between matched stamps [s]",
        Between{0.0, 1e9});
  visit("closures.max_interval",
        o.reach.max_gap,
        "maximum gap interpolated in the reference or other run [s]",
        Between{0.0, 1e9});
  false_closure_fields(o.false_closures, visit);
  visit("anchors.file",
        o.anchors_file,
        "file with measured positions: stamp x y z [sigma, or 6 columns of covariance], or any "
        "format of a reference; empty: none");
  visit("anchors.sigma",
        o.anchors_sigma,
        "standard deviation of measured positions that state none [m]",
        GreaterThan{0.0});
  visit("anchors.max_gap",
        o.anchors_max_gap,
        "maximum time between the poses around a measured position [s]",
        Between{0.0, 1e9});
  planar_field(o.planar, visit);
  visit("seed", o.seed, "random seed of the noise on closures from the reference");
  noise_stream_field(o.stream, visit);
  visit("sensor", o.sensor, "sensor, free text copied to the results");
  visit("licence", o.licence, "licence of the data, free text copied to the results");
}

/// Throws OptionError if a required file is not set, or if a `given` option has no effect because
/// of another option, naming both.
void check_combination(const TrajectoryOptions& options, const Params& given);

/// Contents of the input files.
struct TrajectoryInputs {
  Trajectory estimate;
  Trajectory frames;                      ///< empty: non-keyframe poses of the estimate are used
  Trajectory reference;                   ///< may be empty
  Trajectory other_run;                   ///< for closures.source estimate
  std::vector<StampedClosure> closures;   ///< for closures.source file
  std::vector<Edge> graph_closures = {};  ///< likewise, if the file is a g2o graph
  std::optional<Vector3> normal = {};     ///< of the plane, in the body; unset: not planar
  std::optional<AnchorFile> anchors = {};
  bool run_is_reference = false;  ///< the other run has the poses of the reference
};

/// Derives a problem from the input files. Endpoints of closures from a closure file always become
/// keyframes. Seeded noise is added to closures from the reference, none to closures from another
/// run. Another run whose path length differs by 25 % or more (monocular scale) is rejected, unless
/// closures.scale is local: then closures are Sim(3) (see with_local_scale), and closures.radius
/// and the ranges of closures.view are in the scale of that run. The indices of added false
/// closures are written to `false_closures` unless it is null. Throws OptionError, InputError. O(n
/// log n).
Problem derive_problem(const TrajectoryInputs& inputs,
                       const TrajectoryOptions& options,
                       std::vector<std::size_t>* false_closures = nullptr);

/// Throws OptionError, InputError.
Sequence load_trajectory(const TrajectoryOptions& options, const DataRoot& root);

}  // namespace loopbench

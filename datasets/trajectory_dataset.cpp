#include "datasets/trajectory_dataset.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <utility>

#include "datasets/bags/bag_trajectory.hpp"
#include "datasets/derive/breaks.hpp"
#include "datasets/trajectory_inputs.hpp"

namespace loopbench {
namespace {

// Drift changes the path length by a few per cent; a monocular run has an arbitrary scale.
constexpr double kMaxScaleRatio = 1.25;

RevisitRule revisit_rule(const TrajectoryOptions& o) {
  constexpr double kDegree = std::numbers::pi / 180.0;
  RevisitRule out{o.closures_radius, o.closures_angle * kDegree, o.closures_min_gap};
  if (o.closures_rule == ClosureRule::view) {
    const ViewOptions& v = o.closures_view;
    out.view = View{
        kDegree * v.horizontal, kDegree * v.vertical, v.nearest, v.farthest, v.share, v.forward};
  }
  return out;
}

std::vector<Edge> in_run(const Trajectory& keyframes,
                         const Trajectory& run,
                         const TrajectoryOptions& o) {
  return measure_closures_in_run(keyframes,
                                 run,
                                 revisit_rule(o),
                                 static_cast<std::size_t>(o.closures_max),
                                 o.reach,
                                 o.closures_noise);
}

void require_same_scale(const Trajectory& keyframes,
                        const TrajectoryInputs& in,
                        const InterpolationLimits& reach,
                        const std::string& file) {
  const double ratio = path_length_ratio(keyframes, in.other_run, reach);
  if (ratio < kMaxScaleRatio && ratio > 1.0 / kMaxScaleRatio) return;
  throw input_error(file,
                    0,
                    fmt::format("path length is {:.3g} times that of the estimate at the same "
                                "stamps, expected the same scale (for monocular runs set "
                                "closures.scale: local)",
                                ratio));
}

std::size_t keyframe_index(const std::vector<std::size_t>& kept, std::size_t pose) {
  return static_cast<std::size_t>(std::lower_bound(kept.begin(), kept.end(), pose) - kept.begin());
}

std::string name_of(const std::string& estimate) {
  const std::filesystem::path path(file_of(estimate));
  return names_bag(estimate) ? path.stem().string() + "_" + bag_name(estimate).topic
                             : default_name(path);
}

std::string closure_provenance(const TrajectoryOptions& o, std::size_t count) {
  const auto& [sigma_t, sigma_r] = o.closures_noise;
  switch (o.closures) {
    case ClosureSource::none:
      return "none";
    case ClosureSource::file:
      return fmt::format("file: {} ({})", o.closures_file, count);
    case ClosureSource::reference:
      return fmt::format(
          "reference with noise {} m, {} rad, seed {} ({})", sigma_t, sigma_r, o.seed, count);
    case ClosureSource::estimate:
      return fmt::format("estimate: {}{} ({})",
                         o.closures_file,
                         o.closures_scale == ClosureScale::local ? ", in Sim(3)" : "",
                         count);
  }
  return "";
}

std::uint64_t identity(const TrajectoryOptions& o, const Trajectory& keyframes) {
  if (!o.stream.empty()) return noise_identity(o.stream);
  return noise_identity(identity_text("trajectory", o, is_data_option), keyframes);
}

/// Name and provenance of a sequence with its closures.
void describe(const TrajectoryInputs& in,
              const TrajectoryOptions& o,
              std::size_t false_closures,
              Sequence& sequence) {
  sequence.name = o.name.empty() ? name_of(o.estimate) : o.name;
  Provenance& provenance = sequence.provenance;
  provenance.sensor = o.sensor;
  provenance.licence = o.licence;
  provenance.body_from_reference = pose_of(o.reference_body);
  const std::size_t all = sequence.problem.closures.size();
  provenance.closures = closure_provenance(o, all) +
                        (in.run_is_reference ? ", which is the reference" : "") +
                        false_closures_text(o.false_closures, false_closures, all);
  provenance.oracle_closures = o.closures == ClosureSource::reference || in.run_is_reference;
}

PlanarParts parts_of(TrajectoryInputs& in) {
  PlanarParts out{{{"the estimate", &in.estimate},
                   {"the frames", &in.frames},
                   {"the reference", &in.reference},
                   {"the other run", &in.other_run}},
                  {}};
  for (StampedClosure& each : in.closures) out.measurements.push_back(&each.from_from_to);
  for (Edge& each : in.graph_closures) out.measurements.push_back(&each.from_from_to);
  return out;
}

}  // namespace

Problem derive_problem(const TrajectoryInputs& in,
                       const TrajectoryOptions& o,
                       std::vector<std::size_t>* false_closures) {
  std::vector<std::size_t> kept = choose_keyframes(in.estimate, o.keyframes);
  for (const std::size_t arriving : breaks_at_stamps(o.breaks, in.estimate, o.reach.max_diff)) {
    kept.insert(kept.end(), {arriving - 1, arriving});  // frames between two maps are in neither
  }
  std::vector<Edge> closures;
  if (o.closures == ClosureSource::file) {
    closures = in.graph_closures;
    if (!in.closures.empty()) {
      closures = as_edges(in.closures, in.estimate, o.reach.max_diff, o.closures_file);
    }
    for (const Edge& edge : closures) kept.insert(kept.end(), {edge.from, edge.to});
  }
  std::sort(kept.begin(), kept.end());
  kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
  for (Edge& edge : closures) {
    edge.from = keyframe_index(kept, edge.from);
    edge.to = keyframe_index(kept, edge.to);
  }

  Problem problem;
  KeyframeSplit poses = split(in.estimate, kept);
  problem.keyframes = std::move(poses.keyframes);
  problem.frames = in.frames.empty() ? std::move(poses.frames)
                                     : non_keyframes_between(problem.keyframes, in.frames);
  problem.odometry = odometry_edges(problem.keyframes, o.odometry);
  free_steps(problem, breaks_at_stamps(o.breaks, problem.keyframes, o.reach.max_diff));
  const std::uint64_t noise = identity(o, problem.keyframes);
  if (o.closures == ClosureSource::reference) {
    closures = with_noise(
        in_run(problem.keyframes, in.reference, o), o.closures_noise, {o.seed, noise}, in.normal);
  } else if (o.closures == ClosureSource::estimate) {
    closures = in_run(problem.keyframes, in.other_run, o);
    if (o.closures_scale == ClosureScale::local) {
      closures = with_local_scale(std::move(closures), problem.keyframes, in.other_run, o.reach);
    } else {
      require_same_scale(problem.keyframes, in, o.reach, o.closures_file);
    }
  }
  problem.closures = std::move(closures);
  problem.planar = in.normal.has_value();
  std::vector<std::size_t> added = add_false_closures(problem, o.false_closures, noise);
  if (false_closures != nullptr) *false_closures = std::move(added);
  return problem;
}

Sequence load_trajectory(const TrajectoryOptions& o, const DataRoot& root) {
  check_combination(o, {});
  Sequence sequence;
  TrajectoryInputs in = read_inputs(o, root, sequence.provenance);
  const PlanarChoice plane = choose_planar(o.planar, parts_of(in));
  if (plane.planar) in.normal = plane.normal;
  if (!plane.note.empty()) sequence.provenance.notes.push_back(plane.note);
  const Trajectory& tracked = in.frames.empty() ? in.estimate : in.frames;
  if (const auto moved = move_to_poses(in.closures, in.estimate, tracked, o.reach); moved > 0) {
    sequence.provenance.notes.push_back(
        fmt::format("{} of {} closures are at stamps between poses of the estimate: moved to the "
                    "nearest one by the motion of the tracked poses",
                    moved,
                    in.closures.size()));
  }
  std::vector<std::size_t> false_closures;
  sequence.problem = derive_problem(in, o, &false_closures);
  if (in.anchors) {
    const Trajectory& run = in.frames.empty() ? in.estimate : in.frames;
    add_anchors(*in.anchors, o.anchors_file, run, o.anchors_max_gap, sequence);
  }
  if (const std::size_t count = count_without_scale(sequence.problem.closures); count > 0) {
    sequence.provenance.notes.push_back(
        fmt::format("{} of {} closures state no scale: around them the runs move by less than the "
                    "noise of their positions",
                    count,
                    sequence.problem.closures.size()));
  }
  const std::vector<std::size_t> breaks =
      breaks_at_stamps(o.breaks, sequence.problem.keyframes, o.reach.max_diff);
  if (!breaks.empty()) sequence.provenance.notes.push_back(breaks_note(sequence.problem, breaks));
  describe(in, o, false_closures.size(), sequence);
  if (o.closures == ClosureSource::reference || o.false_closures.share > 0.0) {
    sequence.false_closures = std::move(false_closures);
  }
  sequence.reference = std::move(in.reference);
  if (plane.planar) set_body(sequence, plane.body_from_plane());
  check(sequence.problem, sequence.name);
  check(sequence.reference, sequence.name + ": reference", Rotations::optional);
  return sequence;
}

}  // namespace loopbench

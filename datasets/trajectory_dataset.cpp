#include "datasets/trajectory_dataset.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <optional>

#include "datasets/bags/bag_trajectory.hpp"
#include "datasets/columns/stamp_unit.hpp"
#include "datasets/core/disabled_options.hpp"

namespace loopbench {
namespace {

// Drift changes the path length by a few per cent; a monocular run has an arbitrary scale.
constexpr double kMaxScaleRatio = 1.25;

RevisitRule revisit_rule(const TrajectoryOptions& o) {
  return {o.closures_radius, o.closures_angle * std::numbers::pi / 180.0, o.closures_min_gap};
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

/// Rejects options that need the rotations of a reference without any.
void require_no_rotations(const TrajectoryOptions& o) {
  const std::string why = o.reference + " has positions without rotation";
  require_option(o.closures != ClosureSource::reference,
                 "closures.source",
                 "reference needs rotations, but " + why);
  require_option(!has_offset(o.reference_body),
                 "reference_body",
                 "needs rotations, but " + why + "; `eval --ref-body` moves the estimates instead");
}

/// A stated offset or period is accepted instead of stamps.
void require_common_time(const FileClock& estimate,
                         const FileClock& other,
                         const TrajectoryOptions& o) {
  const bool is_mixed = (estimate.clock == Clock::stamps) != (other.clock == Clock::stamps);
  if (o.offset != 0.0 || (is_mixed && o.period != TrajectoryOptions{}.period)) return;
  const std::string why = why_no_common_time(estimate, other);
  if (!why.empty()) throw InputError(why);
}

std::uint64_t identity(const TrajectoryOptions& o, const Trajectory& keyframes) {
  if (!o.stream.empty()) return noise_identity(o.stream);
  return noise_identity(identity_text("trajectory", o, is_data_option), keyframes);
}

bool same_bits(const Trajectory& a, const Trajectory& b) {
  return std::ranges::equal(a, b, [](const StampedPose& x, const StampedPose& y) {
    return x.stamp == y.stamp && x.world_from_body.translation == y.world_from_body.translation &&
           x.world_from_body.rotation.coeffs() == y.world_from_body.rotation.coeffs();
  });
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
                       std::size_t* false_closures) {
  std::vector<std::size_t> kept = choose_keyframes(in.estimate, o.keyframes);
  std::vector<Edge> closures;
  if (o.closures == ClosureSource::file) {
    closures = in.graph_closures;
    if (!in.closures.empty()) {
      closures = as_edges(in.closures, in.estimate, o.reach.max_diff, o.closures_file);
    }
    for (const Edge& edge : closures) kept.insert(kept.end(), {edge.from, edge.to});
    std::sort(kept.begin(), kept.end());
    kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
    for (Edge& edge : closures) {
      edge.from = keyframe_index(kept, edge.from);
      edge.to = keyframe_index(kept, edge.to);
    }
  }

  Problem problem;
  KeyframeSplit poses = split(in.estimate, kept);
  problem.keyframes = std::move(poses.keyframes);
  problem.frames = in.frames.empty() ? std::move(poses.frames)
                                     : non_keyframes_between(problem.keyframes, in.frames);
  problem.odometry = odometry_edges(problem.keyframes, o.odometry);
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
  const std::size_t added = add_false_closures(problem, o.false_closures, noise);
  if (false_closures != nullptr) *false_closures = added;
  return problem;
}

Sequence load_trajectory(const TrajectoryOptions& o, const DataRoot& root) {
  check_combination(o, {});
  Sequence sequence;
  const auto open = [&](const std::string& path, const std::string& option) {
    return sequence.provenance.inputs.emplace_back(InputPath{root.find(file_of(path)), option})
        .path;
  };
  ReadOptions options{
      .period = o.period, .repeats = o.repeats, .sort = o.sort, .drop_invalid = o.drop_invalid};
  std::optional<std::filesystem::path> times;
  if (!o.times.empty()) times = open(o.times, "times");
  std::optional<FileClock> first;  // the estimate
  TrajectoryInputs in;
  const auto read = [&](const std::string& path, const std::string& option, Format format) {
    if (path.empty()) return Trajectory();
    options.format = format;
    options.positions = option == "reference";
    std::filesystem::path file = open(path, option);
    if (names_bag(path)) file = to_text(BagName{file.string(), bag_name(path).topic});
    ReadFindings findings;
    options.findings = &findings;
    options.stamp_unit = o.stamp_unit;
    options.times.reset();
    if (times && (names_bag(path) || takes_times(file, detect_format(file)))) options.times = times;
    Trajectory out = read_trajectory(file, options);
    if (first) options.stamp_unit = better_unit(out, findings, in.estimate);
    if (first && options.stamp_unit != StampUnit::automatic) {
      findings = {};
      out = read_trajectory(file, options);
    }
    require_clear_unit(path, findings);
    const FileClock clock{path, findings.clock, out.size() + findings.invalid};
    if (!first) first = clock;
    require_common_time(*first, clock, o);
    std::vector<std::string>& notes = sequence.provenance.notes;
    for (const std::string& note : reading_notes(findings)) notes.push_back(path + ": " + note);
    if (findings.origin) notes.push_back(path + ": " + to_text(*findings.origin));
    if (!findings.damage.empty()) notes.push_back(path + ": " + findings.damage);
    return out;
  };

  in.estimate = read(o.estimate, "estimate", o.format);
  in.frames = read(o.frames, "frames", o.format);
  in.reference = read(o.reference, "reference", o.reference_format);
  for (StampedPose& pose : in.reference) pose.stamp -= o.offset;
  if (!o.reference.empty()) sequence.provenance.reference = sequence.provenance.inputs.back().path;
  if (lacks_rotations(in.reference)) require_no_rotations(o);
  if (o.closures == ClosureSource::estimate) {
    in.other_run = read(o.closures_file, "closures.file", o.format);
  }
  const bool run_is_reference = o.closures == ClosureSource::estimate && !in.reference.empty() &&
                                same_bits(in.other_run, in.reference);
  in.reference = to_estimate_body(std::move(in.reference), o.reference_body);
  if (o.closures == ClosureSource::file) {
    const std::filesystem::path file = open(o.closures_file, "closures.file");
    if (file.extension() == ".g2o") {
      in.graph_closures = read_graph_closures(file, in.estimate);
    } else {
      in.closures = read_closure_file(file, o.closures_noise);
    }
  }

  const PlanarChoice plane = choose_planar(o.planar, parts_of(in));
  if (plane.planar) in.normal = plane.normal;
  if (!plane.note.empty()) sequence.provenance.notes.push_back(plane.note);

  sequence.name = o.name.empty() ? name_of(o.estimate) : o.name;
  std::size_t false_closures = 0;
  sequence.problem = derive_problem(in, o, &false_closures);
  sequence.reference = std::move(in.reference);
  sequence.provenance.sensor = o.sensor;
  sequence.provenance.licence = o.licence;
  sequence.provenance.body_from_reference = pose_of(o.reference_body);
  const std::size_t all = sequence.problem.closures.size();
  sequence.provenance.closures = closure_provenance(o, all) +
                                 (run_is_reference ? ", which is the reference" : "") +
                                 false_closures_text(o.false_closures, false_closures, all);
  sequence.provenance.oracle_closures = o.closures == ClosureSource::reference || run_is_reference;
  if (!o.anchors_file.empty()) {
    std::filesystem::path file = open(o.anchors_file, "anchors.file");
    if (names_bag(o.anchors_file)) {
      file = to_text(BagName{file.string(), bag_name(o.anchors_file).topic});
    }
    add_anchors(read_anchor_file(file, o.anchors_sigma),
                o.anchors_file,
                in.frames.empty() ? in.estimate : in.frames,
                o.anchors_max_gap,
                sequence);
  }
  if (plane.planar) set_body(sequence, plane.body_from_plane());
  check(sequence.problem, sequence.name);
  check(sequence.reference, sequence.name + ": reference", Rotations::optional);
  return sequence;
}

}  // namespace loopbench

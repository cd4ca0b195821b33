#include "datasets/pose_graph_dataset.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "datasets/core/disabled_options.hpp"
#include "datasets/derive/breaks.hpp"
#include "datasets/derive/closures.hpp"
#include "datasets/derive/graph_parts.hpp"
#include "datasets/derive/odometry.hpp"
#include "datasets/formats/formats.hpp"

namespace loopbench {
namespace {

/// Columns are the vehicle axes in camera axes: x forward = z, y left = -x, z up = -y.
Rotation camera_from_vehicle() {
  Matrix3 axes;
  axes << 0.0, -1.0, 0.0,  //
      0.0, 0.0, -1.0,      //
      1.0, 0.0, 0.0;
  return Rotation(axes);
}

std::vector<std::size_t> kept_poses(std::size_t size,
                                    std::size_t step,
                                    const std::vector<Edge>& closures,
                                    const std::vector<std::size_t>& breaks,
                                    const PoseGraph& graph) {
  std::vector<bool> keep(size, false);
  for (const std::size_t arriving : breaks) keep[arriving - 1] = keep[arriving] = true;
  for (const std::size_t vertex : graph.fixed) keep[vertex] = true;
  for (const Anchor& prior : graph.priors) keep[prior.keyframe] = true;
  for (std::size_t i = 0; i < size; i += step) keep[i] = true;
  if (size > 0) keep.back() = true;
  for (const Edge& edge : closures) keep[edge.from] = keep[edge.to] = true;
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < size; ++i) {
    if (keep[i]) kept.push_back(i);
  }
  return kept;
}

/// A g2o ground truth must have ids of the graph, but can lack some. Other formats have no ids and
/// must have one pose per vertex.
Trajectory read_truth(const std::filesystem::path& file,
                      const std::vector<double>& stamps,
                      const PoseGraphOptions& o) {
  ReadOptions options;
  options.format = detect_format(file);
  options.period = o.period;
  Trajectory truth = read_trajectory(file, options);
  const auto invalid = [&](const std::string& what) { return input_error(file.string(), 0, what); };
  if (options.format == Format::g2o) {
    for (const StampedPose& pose : truth) {
      if (std::ranges::binary_search(stamps, pose.stamp)) continue;
      throw invalid(fmt::format("id {:.0f} is not in the graph, expected the ids of the graph",
                                pose.stamp / o.period));
    }
  } else if (truth.size() != stamps.size()) {
    throw invalid(fmt::format("found {} poses, expected {}, the number of vertices of the graph",
                              truth.size(),
                              stamps.size()));
  }
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (options.format != Format::g2o) truth[i].stamp = stamps[i];
  }
  if (o.truth_axes == TruthAxes::kitti_camera) {
    const Pose camera_from_body{camera_from_vehicle(), Vector3::Zero()};
    for (auto& [stamp, pose] : truth) {
      pose = normalized(camera_from_body.inverse() * pose * camera_from_body);
    }
  }
  return to_estimate_body(std::move(truth), o.reference_body);
}

std::uint64_t identity(const PoseGraphOptions& o, const Trajectory& keyframes) {
  if (!o.stream.empty()) return noise_identity(o.stream);
  return noise_identity(identity_text("pose_graph", o, is_data_option), keyframes);
}

std::string closure_provenance(const PoseGraphOptions& o,
                               const PoseGraph& graph,
                               std::size_t count,
                               std::size_t false_closures) {
  std::string text = "none";
  if (o.closures == GraphClosures::edges) {
    text =
        fmt::format("edges of {} ({})", std::filesystem::path(o.path).filename().string(), count);
    if (!o.true_list.empty()) text += ", only those that are true according to " + o.true_list;
    if (o.skip_placeholders) text += ", without placeholders";
  }
  text += false_closures_text(o.false_closures, false_closures, count);
  if (graph.altered > 0) {
    const char* how =
        o.rules.indefinite == IndefiniteInformation::repair ? "repaired" : "projected";
    text += fmt::format("; indefinite information of {} edges {}", graph.altered, how);
  }
  if (graph.similarity) text += "; Sim(3) chain: keyframes are its rigid part";
  return text;
}

/// Adds closures with the poses of fixed vertices relative to the first of them and much more
/// information than the odometry has, so that every method that uses closures holds them. Indices
/// of false closures follow them.
void hold_fixed(const PoseGraph& graph,
                Sequence& sequence,
                std::vector<std::size_t>& false_closures) {
  if (graph.fixed.empty() || graph.vertices.empty()) return;
  Problem& problem = sequence.problem;
  Provenance& provenance = sequence.provenance;
  for (const std::size_t vertex : graph.fixed) {
    const auto found = std::ranges::lower_bound(problem.ids, graph.ids[vertex]);
    provenance.fixed.push_back(static_cast<std::size_t>(found - problem.ids.begin()));
  }
  double translation = 0.0, rotation = 0.0;
  for (const Edge& edge : problem.odometry) {
    translation = std::max(translation, edge.information.diagonal().head<3>().maxCoeff());
    rotation = std::max(rotation, edge.information.diagonal().tail<3>().maxCoeff());
  }
  constexpr double kHold = 1e5;  // below the stiffness that solvers bound
  const Matrix6 information =
      isotropic_information(1.0 / (kHold * translation), 1.0 / (kHold * rotation));
  const auto& poses = problem.keyframes;
  const std::size_t first = provenance.fixed.front();
  for (const std::size_t k : provenance.fixed) {
    if (k == first) continue;
    const Pose step = poses[first].world_from_body.inverse() * poses[k].world_from_body;
    provenance.held.push_back({first, k, normalized(step), information});
  }
  problem.closures.insert(problem.closures.end(), provenance.held.begin(), provenance.held.end());
  sort_closures(problem.closures, &false_closures);
  if (provenance.held.empty()) return;
  provenance.notes.push_back(fmt::format(
      "FIX: {} vertices are held by closures with 1e5 times the information of the odometry",
      graph.fixed.size()));
}

/// For SE(3) edges; those of EDGE_SE2 lines are planar already.
void make_planar(Planar wanted, Sequence& sequence) {
  Problem& problem = sequence.problem;
  PlanarParts parts{{{"the graph", &problem.keyframes},
                     {"the poses between keyframes", &problem.frames},
                     {"the truth", &sequence.reference}},
                    {}};
  for (std::vector<Edge>* const edges : {&problem.odometry, &problem.closures}) {
    for (Edge& edge : *edges) parts.measurements.push_back(&edge.from_from_to);
  }
  const PlanarChoice plane = choose_planar(wanted, parts);
  if (!plane.note.empty()) sequence.provenance.notes.push_back(plane.note);
  problem.planar = plane.planar;
  if (plane.planar) set_body(sequence, plane.body_from_plane());
}

}  // namespace

void check_combination(const PoseGraphOptions& o, const Params& given) {
  if (o.path.empty()) throw OptionError("path", "path: is empty, expected a g2o file");
  pose_of(o.reference_body);  // throws if it is not a valid pose
  if (o.truth.empty()) {
    reject_disabled_by_missing(given, "reference_body.", "truth");
    reject_disabled_by_missing(given, "truth_axes", "truth");
  }
  if (o.closures == GraphClosures::none) {
    reject_disabled(given,
                    {"closures.max", "closures.skip_placeholders", "closures.true_list"},
                    "closures.source",
                    "none",
                    "edges");
    if (o.false_closures.share > 0.0) {
      reject_disabled(given, {"false_closures.share"}, "closures.source", "none", "edges");
    }
  }
}

Problem derive_problem(const PoseGraph& graph,
                       const PoseGraphOptions& o,
                       const std::filesystem::path& file,
                       const std::filesystem::path& true_list,
                       std::vector<std::size_t>* false_closures) {
  GraphParts parts = split_graph(graph, file);
  const Trajectory poses = initial_poses(graph, o.period);
  std::vector<Edge>& closures = parts.closures;
  if (o.closures == GraphClosures::none) closures.clear();
  if (!true_list.empty()) keep_listed(closures, graph.ids, true_list);
  if (o.skip_placeholders) drop_placeholders(closures);
  subsample_closures(closures, poses, static_cast<std::size_t>(o.closures_max));

  const auto kept = kept_poses(poses.size(),
                               static_cast<std::size_t>(o.keyframes_every),
                               closures,
                               breaks_at_ids(o.breaks, graph.ids),
                               graph);
  std::vector<std::size_t> keyframe_of(poses.size(), 0);
  for (std::size_t k = 0; k < kept.size(); ++k) keyframe_of[kept[k]] = k;
  for (Edge& edge : closures) {
    edge.from = keyframe_of[edge.from];
    edge.to = keyframe_of[edge.to];
  }
  sort_closures(closures);

  Problem problem;
  KeyframeSplit parts_of_poses = split(poses, kept);
  problem.keyframes = std::move(parts_of_poses.keyframes);
  problem.frames = std::move(parts_of_poses.frames);
  if (kept.size() < poses.size())
    require_complete_odometry(parts, graph, file, "if poses are omitted between keyframes");
  problem.odometry =
      kept.size() < poses.size() ? bridge(parts.odometry, kept) : std::move(parts.odometry);
  problem.closures = std::move(closures);
  for (const std::size_t k : kept) problem.ids.push_back(graph.ids[k]);
  free_steps(problem, breaks_at_ids(o.breaks, problem.ids));
  problem.anchors = graph.priors;
  for (Anchor& anchor : problem.anchors) anchor.keyframe = keyframe_of[anchor.keyframe];
  std::ranges::stable_sort(problem.anchors, {}, &Anchor::keyframe);
  problem.planar = graph.planar && o.planar != Planar::no;
  std::vector<std::size_t> added =
      add_false_closures(problem, o.false_closures, identity(o, problem.keyframes));
  if (false_closures != nullptr) *false_closures = std::move(added);
  return problem;
}

Sequence load_pose_graph(const PoseGraphOptions& o, const DataRoot& root) {
  check_combination(o, {});
  const bool lists = !o.true_list.empty() && o.closures == GraphClosures::edges;
  Sequence sequence;
  auto& inputs = sequence.provenance.inputs;
  const auto open = [&](const std::string& path, const std::string& option) {
    if (path.empty()) return std::filesystem::path();
    return inputs.emplace_back(InputPath{root.find(path), option}).path;
  };
  const std::filesystem::path file = open(o.path, "path");
  const PoseGraph graph = read_g2o(file, o.rules);
  std::vector<std::size_t> false_closures;
  sequence.problem = derive_problem(
      graph, o, file, open(lists ? o.true_list : "", "closures.true_list"), &false_closures);
  if (!o.truth.empty()) {
    sequence.provenance.reference = open(o.truth, "truth");
    sequence.reference =
        read_truth(sequence.provenance.reference, vertex_stamps(graph, o.period), o);
  }

  require_option(!graph.similarity || o.planar != Planar::yes,
                 "planar",
                 "yes has no effect on edges that change the scale, expected auto or no");
  if (!graph.planar && !graph.similarity) make_planar(o.planar, sequence);
  hold_fixed(graph, sequence, false_closures);
  if (!graph.priors.empty()) {
    sequence.provenance.notes.push_back(
        fmt::format("priors are anchors ({}): their positions are used, their rotations are not",
                    graph.priors.size()));
  }
  for (const auto& [tag, count] : graph.skipped) {
    sequence.provenance.notes.push_back(fmt::format(
        "{} {} {} not used", count, tag, count == 1 ? "measurement is" : "measurements are"));
  }
  if (graph.scale_correlations > 0) {
    sequence.provenance.notes.push_back(
        fmt::format("the correlations between scale and pose in {} edges are not used",
                    graph.scale_correlations));
  }
  if (const auto breaks = breaks_at_ids(o.breaks, sequence.problem.ids); !breaks.empty()) {
    sequence.provenance.notes.push_back(breaks_note(sequence.problem, breaks));
  }
  sequence.name = o.name.empty() ? default_name(o.path) : o.name;
  sequence.provenance.sensor = o.sensor;
  sequence.provenance.licence = o.licence;
  sequence.provenance.body_from_reference = pose_of(o.reference_body);
  sequence.provenance.closures =
      closure_provenance(o, graph, sequence.problem.closures.size(), false_closures.size());
  if (lists || o.false_closures.share > 0.0) {
    sequence.false_closures = std::move(false_closures);
  }
  sequence.provenance.oracle_closures = lists;
  check(sequence.problem, sequence.name);
  check(sequence.reference, sequence.name + ": reference");
  return sequence;
}

}  // namespace loopbench

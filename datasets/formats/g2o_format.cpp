#include "datasets/columns/columns.hpp"
#include "datasets/formats/format_registry.hpp"
#include "datasets/formats/g2o.hpp"
#include "datasets/formats/json_graph.hpp"

namespace loopbench {
namespace {

bool is_graph(const TextFile& file, const Line& line) {
  return is_graph_tag(Columns(file, line).word());
}

// Poses do not depend on the information, which programs write with six digits.
constexpr InformationRules kAny{.indefinite = IndefiniteInformation::project};

/// Poses of the vertices, or of the composed edges; stamps are ids.
Trajectory vertices_of(const PoseGraph& graph, const std::string& name) {
  std::vector<Pose> composed;
  if (graph.vertices.empty()) composed = chain(graph, name);
  const std::vector<Pose>& poses = graph.vertices.empty() ? composed : graph.vertices;
  Trajectory out;
  out.reserve(poses.size());
  const std::vector<double> ids = vertex_stamps(graph, 1.0);
  for (std::size_t i = 0; i < poses.size(); ++i) out.push_back({ids[i], poses[i]});
  check(out, name);  // composed poses may overflow
  return out;
}

Trajectory read_vertices(TextFile& file, const ReadOptions&) {
  file.repaired.clock = Clock::ids;
  return vertices_of(read_g2o(file, kAny), file.name());
}

TrajectoryFile read_json_vertices(const std::filesystem::path& file, const ReadOptions& options) {
  if (options.times)
    throw InputError(file.string() + ": is a pose graph in JSON, expected no times");
  TrajectoryFile out{.poses = vertices_of(read_json_graph(file, kAny), file.string()),
                     .format = Format::g2o,
                     .has_stamps = false};
  for (StampedPose& pose : out.poses) pose.stamp *= options.period;
  if (options.findings) options.findings->clock = Clock::ids;
  return out;
}

PoseGraph graph_of(const Trajectory& poses) {
  PoseGraph out;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    out.ids.push_back(static_cast<std::int64_t>(i));
    out.vertices.push_back(poses[i].world_from_body);
  }
  return out;
}

TextWriter vertices_text(const TrajectoryFile& file, const std::string&) {
  return g2o_text(graph_of(file.poses));
}

}  // namespace

FormatEntry g2o_format() {
  return {.format = Format::g2o,
          .guess = is_graph,
          .read = read_vertices,
          .takes_times = [](const TextFile&) { return true; },
          .write = vertices_text};
}

FormatEntry json_graph_format() {
  return {.format = Format::g2o, .guess_file = is_json_graph, .read_file = read_json_vertices};
}

}  // namespace loopbench

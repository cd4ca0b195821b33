#include "datasets/columns/columns.hpp"
#include "datasets/formats/format_registry.hpp"
#include "datasets/formats/g2o.hpp"

namespace loopbench {
namespace {

bool is_graph(const TextFile& file, const Line& line) {
  return is_graph_tag(Columns(file, line).word());
}

/// Poses of the vertices, or of the composed edges; stamps are ids.
Trajectory read_vertices(TextFile& file, const ReadOptions&) {
  // Poses do not depend on the information, which programs write with six digits.
  const InformationRules any{.indefinite = IndefiniteInformation::project};
  const PoseGraph graph = read_g2o(file, any);
  std::vector<Pose> composed;
  if (graph.vertices.empty()) composed = chain(graph, file.name());
  const std::vector<Pose>& poses = graph.vertices.empty() ? composed : graph.vertices;
  Trajectory out;
  out.reserve(poses.size());
  const std::vector<double> ids = vertex_stamps(graph, 1.0);
  for (std::size_t i = 0; i < poses.size(); ++i) out.push_back({ids[i], poses[i]});
  check(out, file.name());  // composed poses may overflow
  file.repaired.clock = Clock::ids;
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

}  // namespace loopbench

#include <algorithm>
#include <string>

#include "datasets/formats/g2o.hpp"
#include "datasets/formats/g2o_information.hpp"
#include "datasets/formats/g2o_records.hpp"

namespace loopbench {
namespace {

void place_vertices(const TextFile& file, std::vector<VertexRecord> vertices, PoseGraph& out) {
  std::stable_sort(
      vertices.begin(), vertices.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  out.ids.reserve(vertices.size());
  out.vertices.reserve(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (i > 0 && vertices[i].id == vertices[i - 1].id) {
      throw file.error(vertices[i].line,
                       "vertex " + std::to_string(vertices[i].id) + " is already on line " +
                           std::to_string(vertices[i - 1].line));
    }
    out.ids.push_back(vertices[i].id);
    out.vertices.push_back(vertices[i].world_from_body);
  }
}

void ids_of_edges(const std::vector<EdgeRecord>& edges, PoseGraph& out) {
  out.ids.reserve(2 * edges.size());
  for (const EdgeRecord& edge : edges) {
    out.ids.push_back(edge.from);
    out.ids.push_back(edge.to);
  }
  std::sort(out.ids.begin(), out.ids.end());
  out.ids.erase(std::unique(out.ids.begin(), out.ids.end()), out.ids.end());
}

std::size_t index_of(const TextFile& file,
                     const PoseGraph& graph,
                     std::int64_t id,
                     std::size_t line) {
  const auto found = std::lower_bound(graph.ids.begin(), graph.ids.end(), id);
  if (found == graph.ids.end() || *found != id) {
    throw file.error(line,
                     "edge names vertex " + std::to_string(id) +
                         ", which has no VERTEX line, though others have");
  }
  return static_cast<std::size_t>(found - graph.ids.begin());
}

/// Turned so that it leads from the smaller index to the larger. Translations of a similarity edge
/// keep their unit, as COP-SLAM, where these files come from, keeps it.
Edge forward(Edge edge) {
  if (edge.from < edge.to) return edge;
  std::swap(edge.from, edge.to);
  edge.information = information_of_inverse(edge.from_from_to, edge.information);
  edge.from_from_to = edge.from_from_to.inverse();
  edge.scale = 1.0 / edge.scale;
  return edge;
}

}  // namespace

PoseGraph read_g2o(const std::filesystem::path& path) {
  TextFile file(path);
  Records records = read_records(file);
  PoseGraph out;
  out.planar = records.kind == GraphKind::planar;
  out.similarity = records.kind == GraphKind::similarity;
  if (records.vertices.empty()) {
    ids_of_edges(records.edges, out);
  } else {
    place_vertices(file, std::move(records.vertices), out);
  }
  out.edges.reserve(records.edges.size());
  out.lines.reserve(records.edges.size());
  for (EdgeRecord& record : records.edges) {
    record.edge.from = index_of(file, out, record.from, record.line);
    record.edge.to = index_of(file, out, record.to, record.line);
    out.edges.push_back(forward(record.edge));
    out.lines.push_back(record.line);
  }
  return out;
}

}  // namespace loopbench

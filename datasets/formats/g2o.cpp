#include "datasets/formats/g2o.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "datasets/core/error.hpp"
#include "datasets/files/text_writer.hpp"
#include "datasets/formats/g2o_information.hpp"
#include "datasets/formats/g2o_records.hpp"
#include "datasets/formats/json_graph.hpp"

namespace loopbench {
namespace {

void sort_vertices(const TextFile& file, std::vector<VertexRecord> vertices, PoseGraph& out) {
  const auto by_id = [](const auto& a, const auto& b) { return a.id < b.id; };
  if (!std::is_sorted(vertices.begin(), vertices.end(), by_id)) {
    std::stable_sort(vertices.begin(), vertices.end(), by_id);
  }
  out.ids.reserve(vertices.size());
  out.vertices.reserve(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (i > 0 && vertices[i].id == vertices[i - 1].id) {
      throw file.error(vertices[i].line,
                       "vertex " + id_text(vertices[i].id) + " is already defined on line " +
                           std::to_string(vertices[i - 1].line));
    }
    out.ids.push_back(vertices[i].id);
    out.vertices.push_back(vertices[i].world_from_body);
  }
}

void ids_of_edges(const std::vector<EdgeEnds>& edges, PoseGraph& out) {
  out.ids.reserve(2 * edges.size());
  for (const EdgeEnds& edge : edges) {
    out.ids.push_back(edge.from);
    out.ids.push_back(edge.to);
  }
  std::sort(out.ids.begin(), out.ids.end());
  out.ids.erase(std::unique(out.ids.begin(), out.ids.end()), out.ids.end());
}

std::size_t index_of(const TextFile& file,
                     const PoseGraph& graph,
                     std::int64_t id,
                     std::size_t line,
                     const std::string& what = "edge") {
  const auto found = std::lower_bound(graph.ids.begin(), graph.ids.end(), id);
  if (found == graph.ids.end() || *found != id) {
    throw file.error(
        line,
        what + " refers to vertex " + id_text(id) +
            ", which has no VERTEX line: expected vertices of this file, not of another robot");
  }
  return static_cast<std::size_t>(found - graph.ids.begin());
}

/// Inverts an edge, so that `from` is the smaller index.
void invert_edge(const TextFile& file, std::size_t line, Edge& edge) {
  edge = inverted(edge);
  const bool is_valid = is_finite(edge.from_from_to) && std::isfinite(edge.scale) &&
                        edge.information.allFinite() &&
                        edge.information.llt().info() == Eigen::Success;
  if (!is_valid) {
    throw file.error(line, "information is not positive definite after inversion of the edge");
  }
}

}  // namespace

PoseGraph read_g2o(const std::filesystem::path& path, const InformationRules& rules) {
  if (is_json_graph(path)) return read_json_graph(path, rules);
  TextFile file(path);
  return read_g2o(file, rules);
}

PoseGraph read_g2o(TextFile& file, const InformationRules& rules) {
  Records records = read_records(file, rules);
  PoseGraph out;
  out.altered = records.altered;
  out.scale_correlations = records.scale_correlations;
  out.planar = records.kind == GraphKind::planar;
  out.similarity = records.kind == GraphKind::similarity;
  if (records.vertices.empty()) {
    ids_of_edges(records.ends, out);
  } else {
    sort_vertices(file, std::move(records.vertices), out);
  }
  for (PriorRecord& prior : records.priors) {
    prior.anchor.keyframe = index_of(file, out, prior.id, prior.line, "prior");
    for (const OffsetRecord& offset : records.offsets) {
      if (prior.parameter == offset.id) prior.anchor.point_in_body = offset.point;
    }
    out.priors.push_back(prior.anchor);
  }
  out.skipped = std::move(records.skipped);
  for (const EdgeEnds& fixed : records.fixed) {
    if (std::ranges::find(records.planes, fixed.from) != records.planes.end()) continue;
    out.fixed.push_back(index_of(file, out, fixed.from, fixed.line, "FIX"));
  }
  std::ranges::sort(out.fixed);
  out.fixed.erase(std::unique(out.fixed.begin(), out.fixed.end()), out.fixed.end());
  out.edges = std::move(records.edges);
  out.lines.reserve(out.edges.size());
  for (std::size_t i = 0; i < out.edges.size(); ++i) {
    Edge& edge = out.edges[i];
    const EdgeEnds& ends = records.ends[i];
    edge.from = index_of(file, out, ends.from, ends.line);
    edge.to = index_of(file, out, ends.to, ends.line);
    if (edge.from > edge.to) invert_edge(file, ends.line, edge);
    out.lines.push_back(ends.line);
  }
  return out;
}

std::vector<double> vertex_stamps(const PoseGraph& graph, double period) {
  constexpr int kDoubleBits = 53;
  const std::vector<std::int64_t>& ids = graph.ids;
  const bool are_symbols = !ids.empty() && ids.front() >> kSymbolBits > 0;
  const int bits = are_symbols ? kSymbolBits : kDoubleBits;
  const bool is_large = !ids.empty() && ids.back() >> kDoubleBits > 0;
  const auto index_of = [&](std::int64_t id) {
    return is_large ? id & ((std::int64_t{1} << bits) - 1) : id;
  };
  const bool is_ambiguous =
      is_large && std::ranges::adjacent_find(ids, std::greater_equal{}, index_of) != ids.end();
  std::vector<double> out;
  out.reserve(ids.size());
  for (const std::int64_t id : ids) {
    out.push_back(
        (is_ambiguous ? static_cast<double>(out.size()) : static_cast<double>(index_of(id))) *
        period);
  }
  return out;
}

namespace {

/// Poses along the fewest edges from the first vertex.
std::vector<Pose> spanning_tree(const PoseGraph& graph, const std::string& name) {
  const std::size_t count = graph.ids.size();
  std::vector<std::vector<const Edge*>> edges_of(count);
  for (const Edge& edge : graph.edges) {
    for (const std::size_t end : {edge.from, edge.to}) edges_of[end].push_back(&edge);
  }
  std::vector<Pose> out(count);
  std::vector<double> scale(count, 0.0);  // relative to the first vertex; 0: not reached
  std::vector<std::size_t> queue{0};
  scale[0] = 1.0;
  for (std::size_t k = 0; k < queue.size(); ++k) {
    const std::size_t at = queue[k];
    for (const Edge* const edge : edges_of[at]) {
      const std::size_t next = edge->from == at ? edge->to : edge->from;
      if (scale[next] != 0.0) continue;
      Edge step = edge->from == at ? *edge : inverted(*edge);
      step.from_from_to.translation *= scale[at];
      out[next] = normalized(out[at] * step.from_from_to);
      scale[next] = scale[at] * step.scale;
      queue.push_back(next);
    }
  }
  if (queue.size() == count) return out;
  const auto lost = std::ranges::find(scale, 0.0) - scale.begin();
  throw InputError(name + ": no edges connect vertices " + id_text(graph.ids[0]) + " and " +
                   id_text(graph.ids[static_cast<std::size_t>(lost)]) +
                   ", expected a connected graph in a file without VERTEX lines");
}

}  // namespace

std::vector<Pose> chain(const PoseGraph& graph, const std::string& name) {
  const std::size_t count = graph.ids.size();
  std::vector<const Edge*> step(count, nullptr);
  for (const Edge& edge : graph.edges) {
    if (edge.from + 1 == edge.to && step[edge.from] == nullptr) step[edge.from] = &edge;
  }
  std::vector<Pose> out(count);
  if (std::ranges::count(step, nullptr) > 1) return spanning_tree(graph, name);
  double scale = 1.0;  // of vertex i relative to the first vertex
  for (std::size_t i = 0; i + 1 < count; ++i) {
    Pose move = step[i]->from_from_to;
    move.translation *= scale;
    out[i + 1] = normalized(out[i] * move);
    scale *= step[i]->scale;
  }
  return out;
}

namespace {

void write_pose(TextWriter& out, const PoseGraph& graph, const Pose& pose) {
  const Vector3& t = pose.translation;
  const Rotation& q = pose.rotation;
  out.number(t.x()).number(t.y());
  if (graph.planar) {
    out.number(std::remainder(2.0 * std::atan2(q.z(), q.w()), 2.0 * M_PI));
    return;
  }
  out.number(t.z()).number(q.x()).number(q.y()).number(q.z()).number(q.w());
}

/// With the information of the scale as a further row and column, if there is any.
template <class Matrix>
void write_upper(TextWriter& out, const Matrix& information, double of_scale = 0.0) {
  for (int i = 0; i < information.rows(); ++i) {
    for (int j = i; j < information.cols(); ++j) out.number(information(i, j));
    if (of_scale > 0.0) out.number(0.0);
  }
  if (of_scale > 0.0) out.number(of_scale);
}

const char* suffix(const PoseGraph& graph) {
  if (graph.planar) return "SE2";
  return graph.similarity ? "RST3:QUAT" : "SE3:QUAT";
}

}  // namespace

TextWriter g2o_text(const PoseGraph& graph) {
  TextWriter out;
  const std::string vertex = std::string("VERTEX_") + suffix(graph);
  const std::string edge = std::string("EDGE_") + suffix(graph);
  for (std::size_t i = 0; i < graph.vertices.size(); ++i) {
    out.word(vertex).integer(graph.ids[i]);
    write_pose(out, graph, graph.vertices[i]);
    if (graph.similarity) out.number(1.0);
    out.end_line();
  }
  for (const std::size_t fixed : graph.fixed) out.word("FIX").integer(graph.ids[fixed]).end_line();
  for (const Edge& e : graph.edges) {
    out.word(edge).integer(graph.ids[e.from]).integer(graph.ids[e.to]);
    write_pose(out, graph, e.from_from_to);
    if (graph.similarity) out.number(1.0 / e.scale);
    if (graph.planar) {
      write_upper(out, planar_block(e.information));
    } else {
      write_upper(out, to_half_angles(e.information), graph.similarity ? e.scale_information : 0.0);
    }
    out.end_line();
  }
  return out;
}

void write_g2o(const std::filesystem::path& file, const PoseGraph& graph) {
  g2o_text(graph).save(file);
}

}  // namespace loopbench

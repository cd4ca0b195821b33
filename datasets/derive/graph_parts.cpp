#include "datasets/derive/graph_parts.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <map>
#include <stdexcept>

#include "datasets/columns/columns.hpp"
#include "datasets/derive/revisits.hpp"
#include "datasets/formats/g2o.hpp"

namespace loopbench {
namespace {

Matrix6 inverse(const Matrix6& matrix) {
  const Eigen::LLT<Matrix6> factor(matrix);
  if (factor.info() != Eigen::Success) {
    throw std::invalid_argument("information is not positive definite");
  }
  return factor.solve(Matrix6::Identity());
}

/// Composition of consecutive edges. The uncertainty is stored as covariance, so that it is
/// inverted only once.
struct ComposedEdge {
  Pose step;
  double scale;
  Matrix6 covariance;
  double scale_information;

  explicit ComposedEdge(const Edge& edge)
      : step(edge.from_from_to),
        scale(edge.scale),
        covariance(inverse(edge.information)),
        scale_information(edge.scale_information) {}

  /// Converts translation and covariance of `edge` to the scale of the first pose and appends it.
  void append(const Edge& edge) {
    const Pose next{edge.from_from_to.rotation, scale * edge.from_from_to.translation};
    const Matrix6 transport = adjoint(next.inverse());
    Matrix6 added = inverse(edge.information);
    added.topRows<3>() *= scale;
    added.leftCols<3>() *= scale;
    covariance = transport * covariance * transport.transpose() + added;
    step = normalized(step * next);
    scale *= edge.scale;
    const double sum = scale_information + edge.scale_information;  // variances are added
    scale_information *= sum > 0.0 ? edge.scale_information / sum : 0.0;
  }

  Edge edge(std::size_t from, std::size_t to) const {
    Matrix6 information = inverse(covariance);
    information = 0.5 * (information + information.transpose()).eval();
    return {from, to, step, information, scale, scale_information};
  }
};

}  // namespace

GraphParts split_graph(const PoseGraph& graph, const std::filesystem::path& file) {
  const std::size_t size = graph.ids.size();
  GraphParts parts;
  parts.odometry.resize(size > 0 ? size - 1 : 0);
  std::vector<bool> found(parts.odometry.size(), false);
  for (std::size_t k = 0; k < graph.edges.size(); ++k) {
    const Edge& edge = graph.edges[k];
    const auto invalid = [&](const std::string& what) {
      return input_error(file.string(), k < graph.lines.size() ? graph.lines[k] : 0, what);
    };
    if (edge.from == edge.to) throw invalid("the edge connects a pose to itself");
    if (Eigen::LLT<Matrix6>(edge.information).info() != Eigen::Success) {
      throw invalid("the information matrix is not positive definite");
    }
    if (edge.to == edge.from + 1 && !found[edge.from]) {
      parts.odometry[edge.from] = edge;
      found[edge.from] = true;
    } else {
      parts.closures.push_back(edge);
    }
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i]) parts.odometry[kept++] = parts.odometry[i];
  }
  parts.odometry.resize(kept);
  return parts;
}

void require_complete_odometry(const GraphParts& parts,
                               const PoseGraph& graph,
                               const std::filesystem::path& file,
                               const std::string& why) {
  for (std::size_t i = 0; i + 1 < graph.ids.size(); ++i) {
    if (i < parts.odometry.size() && parts.odometry[i].from == i) continue;
    throw input_error(file.string(),
                      0,
                      fmt::format("found no edge between {} and {}, expected odometry between "
                                  "consecutive poses {}",
                                  id_text(graph.ids[i]),
                                  id_text(graph.ids[i + 1]),
                                  why));
  }
}

Trajectory initial_poses(const PoseGraph& graph, double period) {
  const std::vector<Pose> poses = graph.vertices.empty() ? chain(graph) : graph.vertices;
  const std::vector<double> stamps = vertex_stamps(graph, period);
  Trajectory out(stamps.size());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = {stamps[i], poses[i]};
  return out;
}

void drop_placeholders(std::vector<Edge>& closures) {
  std::erase_if(closures, [](const Edge& edge) {
    const auto& [rotation, translation] = edge.from_from_to;
    return translation.isZero(0.0) && rotation.vec().isZero(0.0);
  });
}

namespace {

std::int64_t listed_id(const TextFile& file, const Line& line, Columns& columns) {
  const std::string_view word = columns.word();
  if (const auto id = id_of(word)) return *id;
  throw file.error(line.number, fmt::format("'{}' is no id of a vertex", word));
}

}  // namespace

void keep_listed(std::vector<Edge>& closures,
                 const std::vector<std::int64_t>& ids,
                 const std::filesystem::path& list) {
  struct ListEntry {
    std::size_t line;
    bool found;
  };
  std::map<std::pair<std::int64_t, std::int64_t>, ListEntry> listed;
  TextFile file(list);
  for (Line line; file.next(line);) {
    const std::size_t count = count_columns(file, line);
    if (count != 2) {
      throw file.error(line.number, fmt::format("has {} columns, expected 2: id id", count));
    }
    Columns columns(file, line);
    const std::int64_t a = listed_id(file, line, columns);
    const std::int64_t b = listed_id(file, line, columns);
    listed[std::minmax(a, b)] = {line.number, false};
  }
  std::erase_if(closures, [&](const Edge& edge) {
    const auto entry = listed.find({ids[edge.from], ids[edge.to]});
    if (entry == listed.end()) return true;
    entry->second.found = true;
    return false;
  });
  for (const auto& [pair, entry] : listed) {
    if (entry.found) continue;
    throw file.error(entry.line,
                     fmt::format("the graph has no closure {} {}, expected ids of a closure",
                                 id_text(pair.first),
                                 id_text(pair.second)));
  }
}

void subsample_closures(std::vector<Edge>& closures, const Trajectory& poses, std::size_t max) {
  if (max == 0) return;
  std::vector<Revisit> loops;
  for (const Edge& edge : closures) loops.push_back({edge.from, edge.to});
  std::vector<Edge> kept;
  for (const std::size_t k : subsample(loops, stamps(poses), max)) kept.push_back(closures[k]);
  closures = std::move(kept);
}

std::vector<Edge> bridge(const std::vector<Edge>& chain, const std::vector<std::size_t>& kept) {
  std::vector<Edge> out;
  out.reserve(kept.size());
  for (std::size_t k = 0; k + 1 < kept.size(); ++k) {
    if (kept[k + 1] == kept[k] + 1) {
      out.push_back(chain[kept[k]]);
      out.back().from = k;
      out.back().to = k + 1;
      continue;
    }
    ComposedEdge composed(chain[kept[k]]);
    for (std::size_t i = kept[k] + 1; i < kept[k + 1]; ++i) composed.append(chain[i]);
    out.push_back(composed.edge(k, k + 1));
  }
  return out;
}

}  // namespace loopbench

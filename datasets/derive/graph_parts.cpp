#include "datasets/derive/graph_parts.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>

#include "datasets/derive/compose.hpp"
#include "datasets/revisits.hpp"

namespace loopbench {

GraphParts parts_of(const PoseGraph& graph, const std::filesystem::path& file) {
  const std::size_t size = graph.ids.size();
  GraphParts parts;
  parts.odometry.resize(size > 0 ? size - 1 : 0);
  std::vector<bool> found(parts.odometry.size(), false);
  for (std::size_t k = 0; k < graph.edges.size(); ++k) {
    const Edge& edge = graph.edges[k];
    const auto refuse = [&](const std::string& what) {
      return input_error(file.string(), k < graph.lines.size() ? graph.lines[k] : 0, what);
    };
    if (edge.from == edge.to) throw refuse("the edge joins a pose to itself");
    if (Eigen::LLT<Matrix6>(edge.information).info() != Eigen::Success) {
      throw refuse("the information matrix is not positive definite");
    }
    if (edge.to == edge.from + 1 && !found[edge.from]) {
      parts.odometry[edge.from] = edge;
      found[edge.from] = true;
    } else {
      parts.closures.push_back(edge);
    }
  }
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i]) continue;
    throw input_error(file.string(),
                      0,
                      fmt::format("found no edge between {} and {}, expected odometry between "
                                  "consecutive poses",
                                  graph.ids[i],
                                  graph.ids[i + 1]));
  }
  return parts;
}

std::vector<double> stamps_of(const PoseGraph& graph, double period) {
  std::vector<double> out;
  out.reserve(graph.ids.size());
  for (const std::int64_t id : graph.ids) out.push_back(static_cast<double>(id) * period);
  return out;
}

Trajectory initial_poses(const PoseGraph& graph, const GraphParts& parts, double period) {
  const std::vector<Pose> poses = graph.vertices.empty() ? chained(parts.odometry) : graph.vertices;
  const std::vector<double> stamps = stamps_of(graph, period);
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

void keep_listed(std::vector<Edge>& closures,
                 const std::vector<std::int64_t>& ids,
                 const std::filesystem::path& list) {
  std::ifstream in(list);
  if (!in) throw input_error(list.string(), 0, "cannot be opened");
  std::map<std::pair<std::int64_t, std::int64_t>, std::pair<std::size_t, bool>> lines;
  std::size_t number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    std::istringstream words(line);
    std::int64_t a = 0;
    std::int64_t b = 0;
    std::string rest;
    if (!(words >> rest)) continue;
    words = std::istringstream(line);
    if (!(words >> a >> b) || words >> rest) {
      throw input_error(list.string(), number, "found '" + line + "', expected two ids");
    }
    lines[std::minmax(a, b)] = {number, false};
  }
  std::erase_if(closures, [&](const Edge& edge) {
    const auto listed = lines.find({ids[edge.from], ids[edge.to]});
    if (listed == lines.end()) return true;
    listed->second.second = true;
    return false;
  });
  for (const auto& [pair, seen] : lines) {
    if (seen.second) continue;
    throw input_error(list.string(),
                      seen.first,
                      fmt::format("the graph has no closure {} {}", pair.first, pair.second));
  }
}

void keep_spread(std::vector<Edge>& closures, const Trajectory& poses, std::size_t max) {
  if (max == 0) return;
  std::vector<Revisit> loops;
  for (const Edge& edge : closures) loops.push_back({edge.from, edge.to});
  std::vector<Edge> kept;
  for (const std::size_t k : spread(loops, stamps(poses), max)) kept.push_back(closures[k]);
  closures = std::move(kept);
}

}  // namespace loopbench

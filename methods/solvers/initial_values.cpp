#include "methods/solvers/initial_values.hpp"

#include <deque>

namespace loopbench::methods {
namespace {

/// Edges of each keyframe, stored as one concatenated list.
struct Adjacency {
  struct Incidence {
    const Edge* edge;
    bool is_odometry;
  };
  std::vector<std::size_t> begin;
  std::vector<Incidence> incidences;

  explicit Adjacency(const Problem& problem) : begin(problem.keyframes.size() + 1, 0) {
    const auto visit_edges = [&](auto visit) {
      for (const Edge& edge : problem.odometry) visit(edge, true);
      for (const Edge& edge : problem.closures) visit(edge, false);
    };
    visit_edges([&](const Edge& edge, bool) {
      ++begin[edge.from + 1];
      ++begin[edge.to + 1];
    });
    for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
    incidences.resize(begin.back());
    std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
    visit_edges([&](const Edge& edge, bool is_odometry) {
      incidences[next[edge.from]++] = {&edge, is_odometry};
      incidences[next[edge.to]++] = {&edge, is_odometry};
    });
  }
};

/// Traverses a spanning tree from keyframe 0, odometry before closures. Calls `visit` for each
/// reached keyframe with the edge that reached it; returns which keyframes were reached.
template <class Visit>
std::vector<bool> walk_tree(const Problem& problem, Visit visit) {
  const Adjacency graph(problem);
  std::vector<bool> reached(problem.keyframes.size(), false);
  struct Step {
    std::size_t to;
    std::size_t from;
    const Edge* edge;
  };
  std::deque<Step> queue{{0, 0, nullptr}};
  while (!queue.empty()) {
    const Step step = queue.front();
    queue.pop_front();
    if (reached[step.to]) continue;
    reached[step.to] = true;
    if (step.edge != nullptr) visit(*step.edge, step.from, step.to);
    for (std::size_t w = graph.begin[step.to]; w < graph.begin[step.to + 1]; ++w) {
      const auto& [edge, is_odometry] = graph.incidences[w];
      const std::size_t other = edge->from == step.to ? edge->to : edge->from;
      if (reached[other]) continue;
      if (is_odometry) {
        queue.push_front({other, step.to, edge});
      } else {
        queue.push_back({other, step.to, edge});
      }
    }
  }
  return reached;
}

}  // namespace

std::vector<ScaledPose> tree_values(const Problem& problem) {
  std::vector<ScaledPose> out;
  out.reserve(problem.keyframes.size());
  for (const StampedPose& k : problem.keyframes) out.push_back({k.world_from_body, 1.0});
  if (out.empty()) return out;
  walk_tree(problem, [&](const Edge& edge, std::size_t from, std::size_t to) {
    const ScaledPose step = edge.from == from ? measured(edge) : measured(edge).inverse();
    out[to] = normalized(out[from] * step);
  });
  return out;
}

std::optional<std::size_t> first_unconnected(const Problem& problem) {
  const std::size_t count = problem.keyframes.size();
  if (count == 0) return std::nullopt;
  std::size_t end = 1;  // of the chain from keyframe 0
  for (const Edge& edge : problem.odometry) end += edge.from + 1 == end && edge.to == end;
  if (end >= count) return std::nullopt;
  const std::vector<bool> reached =
      walk_tree(problem, [](const Edge&, std::size_t, std::size_t) {});
  for (std::size_t i = 0; i < reached.size(); ++i) {
    if (!reached[i]) return i;
  }
  return std::nullopt;
}

}  // namespace loopbench::methods

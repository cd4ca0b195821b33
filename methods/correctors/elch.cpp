#include "methods/correctors/elch.hpp"

#include <algorithm>
#include <limits>
#include <queue>

namespace loopbench::methods {
namespace {

/// Graph of the chain 0 - 1 - ... - n-1 and the closures added so far.
class LoopGraph {
 public:
  explicit LoopGraph(std::size_t keyframes) : shortcuts_(keyframes) {}

  void add(const Edge& loop) {
    shortcuts_[loop.from].push_back(loop.to);
    shortcuts_[loop.to].push_back(loop.from);
  }

  /// Computes the share of every keyframe in the closing error of a -> b.
  std::vector<double> shares(std::size_t a, std::size_t b) const {
    std::vector<std::size_t> before(shortcuts_.size());
    const std::vector<double> from_a = distances({a}, before);
    std::vector<std::size_t> path{b};
    while (path.back() != a) path.push_back(before[path.back()]);
    std::vector<double> out(shortcuts_.size());
    for (const std::size_t i : path) out[i] = from_a[i] / from_a[b];
    // Every other keyframe gets the share of the nearest path keyframe.
    const std::vector<double> off_path = distances(path, before);
    std::vector<std::size_t> order(shortcuts_.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return off_path[i]; });
    for (const std::size_t i : order) {
      if (before[i] != i) out[i] = out[before[i]];
    }
    return out;
  }

 private:
  /// Dijkstra's algorithm from several sources. before[i] is the predecessor of i, or i for a
  /// source.
  std::vector<double> distances(const std::vector<std::size_t>& sources,
                                std::vector<std::size_t>& before) const {
    std::vector<double> out(shortcuts_.size(), std::numeric_limits<double>::infinity());
    using Entry = std::pair<double, std::size_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (const std::size_t s : sources) {
      out[s] = 0.0;
      before[s] = s;
      queue.push({0.0, s});
    }
    while (!queue.empty()) {
      const auto [distance, i] = queue.top();
      queue.pop();
      if (distance > out[i]) continue;
      const auto relax = [&, at = i, one_farther = distance + 1.0](std::size_t to) {
        if (one_farther < out[to]) {
          out[to] = one_farther;
          before[to] = at;
          queue.push({out[to], to});
        }
      };
      if (i > 0) relax(i - 1);
      if (i + 1 < shortcuts_.size()) relax(i + 1);
      for (const std::size_t to : shortcuts_[i]) relax(to);
    }
    return out;
  }

  std::vector<std::vector<std::size_t>> shortcuts_;  ///< ends of the closures of each keyframe
};

void distribute_error(Trajectory& poses, const Edge& loop, const std::vector<double>& shares) {
  const LoopCorrection correction(
      poses[loop.from].world_from_body, poses[loop.to].world_from_body, loop, true);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (shares[i] == 0.0) continue;
    poses[i].world_from_body = correction.moved(shares[i], poses[i].world_from_body);
  }
}

}  // namespace

std::string Elch::why_declined(const Problem& problem) const {
  if (problem.closures.empty()) return "the problem has no loop closures";
  return "";
}

Trajectory Elch::correct(const Problem& problem, Report& report) const {
  check_closures(problem, "elch");
  LoopGraph graph(problem.keyframes.size());
  Trajectory out = problem.keyframes;
  for (const Edge& loop : problem.closures) {
    distribute_error(out, loop, graph.shares(loop.from, loop.to));
    graph.add(loop);
  }
  report_closing_errors(problem, out, report);
  return out;
}

}  // namespace loopbench::methods

/// Explicit loop closing heuristic: distributes the closing error by distance in the pose graph.
#pragma once

#include <algorithm>
#include <limits>
#include <utility>

#include "methods/correctors/shares.hpp"

namespace loopbench::methods {

/// Processes the closures a -> b in the order (to, from). For each, it finds the shortest path from
/// a to b, by number of edges, in the graph of odometry and earlier closures. A keyframe i on the
/// path gets the share w_i = d(a, i) / d(a, b); every other keyframe gets the share of the nearest
/// path keyframe. With the pivot o at the loop's start,
///
///     R_i' = Exp(w_i Log dR) R_i,   p_i' = Exp(w_i Log dR) (p_i - o) + o + w_i dt
///
/// for every keyframe, so branches and crossings move together. Without earlier closures this
/// equals `uniform`. O(K n log n) for n keyframes and K closures.
///
/// Source: Sprickerhof, Nuechter, Lingemann, Hertzberg, ECMR 2009. The pivot is the loop's start
/// instead of the world's origin as in common code, so the result does not depend on the world
/// frame.
class Elch final : public LoopCorrector {
 public:
  using Options = NoOptions;
  explicit Elch(const Options&) {}

  /// Counts: `closures`, `largest_closing_error` [m]. Throws std::runtime_error when closures are
  /// not sorted by (to, from) or refer to a missing keyframe.
  Trajectory correct(const Problem& problem, Report& report) const override;
};

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
  /// Numbers of edges from the nearest source, by breadth-first search. before[i] is the
  /// predecessor of i, the one with the lowest index, or i for a source.
  std::vector<double> distances(const std::vector<std::size_t>& sources,
                                std::vector<std::size_t>& before) const {
    std::vector<double> out(shortcuts_.size(), std::numeric_limits<double>::infinity());
    std::vector<std::size_t> reached;
    const auto reach = [&](std::size_t to, std::size_t from, double distance) {
      if (distance >= out[to]) return;
      out[to] = distance;
      before[to] = from;
      reached.push_back(to);
    };
    for (const std::size_t s : sources) reach(s, s, 0.0);
    for (double distance = 1.0; !reached.empty(); ++distance) {
      std::vector<std::size_t> last = std::exchange(reached, {});
      std::ranges::sort(last);
      for (const std::size_t i : last) {
        if (i > 0) reach(i - 1, i, distance);
        if (i + 1 < shortcuts_.size()) reach(i + 1, i, distance);
        for (const std::size_t to : shortcuts_[i]) reach(to, i, distance);
      }
    }
    return out;
  }

  std::vector<std::vector<std::size_t>> shortcuts_;  ///< ends of the closures of each keyframe
};

inline void distribute_error(Trajectory& poses,
                             const Edge& loop,
                             const std::vector<double>& shares) {
  const LoopCorrection correction(
      poses[loop.from].world_from_body, poses[loop.to].world_from_body, loop, true);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (shares[i] == 0.0) continue;
    poses[i].world_from_body = correction.moved(shares[i], poses[i].world_from_body);
  }
}

inline Trajectory Elch::correct(const Problem& problem, Report& report) const {
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

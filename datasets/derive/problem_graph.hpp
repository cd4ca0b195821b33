/// The inverse of reading a pose graph: a problem as vertices and edges.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "datasets/core/problem.hpp"
#include "datasets/formats/g2o.hpp"

namespace loopbench {

/// Whether the poses are those of SE2 lines.
inline bool is_lifted(const Trajectory& poses) {
  constexpr double kRounding = 1e-9;
  return std::ranges::all_of(poses, [](const StampedPose& each) {
    const auto& [q, t] = each.world_from_body;
    return std::abs(t.z()) <= kRounding && std::hypot(q.x(), q.y()) <= kRounding;
  });
}

/// Returns one vertex per pose of `keyframes`, with `ids` (empty: 0, 1, ...), then the odometry
/// edges and the closures of `problem`, unchanged. `keyframes` are those of the problem, before or
/// after correction. SE2 lines if they are planar at z = 0. Throws InputError if there is not one
/// id per keyframe. O(keyframes + edges).
inline PoseGraph problem_graph(const Problem& problem,
                               const Trajectory& keyframes,
                               std::vector<std::int64_t> ids = {}) {
  PoseGraph out;
  out.ids = std::move(ids);
  if (out.ids.empty()) {
    out.ids.resize(keyframes.size());
    std::iota(out.ids.begin(), out.ids.end(), std::int64_t{0});
  }
  if (out.ids.size() != keyframes.size()) {
    throw InputError("a graph of " + std::to_string(keyframes.size()) + " keyframes has " +
                     std::to_string(out.ids.size()) + " ids, expected one per keyframe");
  }
  out.vertices.reserve(keyframes.size());
  for (const StampedPose& pose : keyframes) out.vertices.push_back(pose.world_from_body);
  out.edges = problem.odometry;
  out.edges.insert(out.edges.end(), problem.closures.begin(), problem.closures.end());
  out.planar = problem.planar && is_lifted(problem.keyframes) && is_lifted(keyframes);
  out.similarity = std::ranges::any_of(out.edges, [](const Edge& e) { return e.scale != 1.0; });
  return out;
}

}  // namespace loopbench

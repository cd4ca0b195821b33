/// Truth of graphs that were simulated in steps of whole metres and quarter turns.
#pragma once

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <optional>
#include <vector>

#include "datasets/core/error.hpp"
#include "datasets/formats/g2o.hpp"

namespace loopbench {

/// A pose of a grid world: position [m] and number of quarter turns, 0 to 3.
struct GridPose {
  std::int64_t x = 0;
  std::int64_t y = 0;
  std::int64_t turns = 0;

  friend bool operator==(const GridPose&, const GridPose&) = default;
};

inline GridPose compose(const GridPose& pose, const GridPose& step) {
  constexpr std::array<std::int64_t, 4> kCosine{1, 0, -1, 0};
  const std::int64_t c = kCosine[static_cast<std::size_t>(pose.turns)];
  const std::int64_t s = kCosine[static_cast<std::size_t>((pose.turns + 3) % 4)];
  return {pose.x + c * step.x - s * step.y,
          pose.y + s * step.x + c * step.y,
          (pose.turns + step.turns) % 4};
}

/// The pose of every vertex, from the odometry with every step rounded. Every step must move, and
/// all other edges, rounded, must lead to the same poses: that many measurements agree only if the
/// world is such a grid and the noise is below half a step. Throws InputError `file:line: what` if
/// the graph is not planar, a step or an edge breaks these rules, or consecutive vertices have no
/// edge. O(vertices + edges).
inline std::vector<Pose> grid_truth(const PoseGraph& graph, const std::filesystem::path& file) {
  if (!graph.planar) throw input_error(file.string(), 0, "is not planar, as truth_grid needs");
  const auto rounded = [](const Edge& edge) {
    const Rotation& q = edge.from_from_to.rotation;
    const double yaw = 2.0 * std::atan2(q.z(), q.w());
    const std::int64_t turns = std::llround(yaw / (std::numbers::pi / 2.0));
    const Vector3& p = edge.from_from_to.translation;
    return GridPose{std::llround(p.x()), std::llround(p.y()), ((turns % 4) + 4) % 4};
  };
  std::vector<std::optional<GridPose>> step(graph.ids.size());
  for (const Edge& edge : graph.edges) {
    if (edge.to == edge.from + 1 && !step[edge.from]) step[edge.from] = rounded(edge);
  }
  std::vector<GridPose> poses(graph.ids.size());
  for (std::size_t i = 1; i < poses.size(); ++i) {
    if (!step[i - 1]) {
      const auto gap = fmt::format("no edge between {} and {}", graph.ids[i - 1], graph.ids[i]);
      throw input_error(file.string(), 0, "found " + gap + ", truth_grid needs all odometry");
    }
    poses[i] = compose(poses[i - 1], *step[i - 1]);
  }
  for (std::size_t i = 0; i < graph.edges.size(); ++i) {
    const Edge& edge = graph.edges[i];
    if (edge.to == edge.from + 1 && rounded(edge) == GridPose{}) {
      throw input_error(
          file.string(),
          graph.lines[i],
          "a step of less than half a metre and an eighth of a turn: not the graph of "
          "a grid (truth_grid)");
    }
    if (compose(poses[edge.from], rounded(edge)) == poses[edge.to]) continue;
    throw input_error(file.string(),
                      graph.lines[i],
                      "this edge and the odometry, in whole metres and quarter turns, lead to "
                      "different poses: not the graph of a grid (truth_grid)");
  }
  std::vector<Pose> out;
  for (const GridPose& pose : poses) {
    const double half = static_cast<double>(pose.turns) * std::numbers::pi / 4.0;
    out.push_back({Rotation(std::cos(half), 0.0, 0.0, std::sin(half)),
                   {static_cast<double>(pose.x), static_cast<double>(pose.y), 0.0}});
  }
  return out;
}

}  // namespace loopbench

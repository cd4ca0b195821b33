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

/// The pose of every vertex, from the odometry with every step rounded. It is the truth of a graph
/// whose every step moves, with closures, where all edges, rounded, lead to the same poses, and
/// where rounding changes steps by less than 5 cm on average (a path of 1.3 m steps would also
/// agree with itself). Throws InputError `file:line: what` if the graph is not planar or breaks
/// these rules, or if consecutive vertices have no edge. O(vertices + edges).
inline std::vector<Pose> grid_truth(const PoseGraph& graph, const std::filesystem::path& file) {
  if (!graph.planar) {
    throw input_error(file.string(), 0, "truth_grid: the graph is not planar, expected SE2 edges");
  }
  const auto rounded = [](const Edge& edge) {
    const Rotation& q = edge.from_from_to.rotation;
    const double yaw = 2.0 * std::atan2(q.z(), q.w());
    const std::int64_t turns = std::llround(yaw / (std::numbers::pi / 2.0));
    const Vector3& p = edge.from_from_to.translation;
    return GridPose{std::llround(p.x()), std::llround(p.y()), ((turns % 4) + 4) % 4};
  };
  const auto no_grid = [&](std::size_t line, const std::string& why) {
    return input_error(file.string(), line, "truth_grid: not simulated in a grid: " + why);
  };
  std::vector<std::optional<GridPose>> step(graph.ids.size());
  Vector3 sum = Vector3::Zero();
  std::size_t steps = 0;
  for (std::size_t i = 0; i < graph.edges.size(); ++i) {
    const Edge& edge = graph.edges[i];
    if (edge.to != edge.from + 1) continue;
    const GridPose near = rounded(edge);
    if (near == GridPose{}) throw no_grid(graph.lines[i], "a step that rounds to standing still");
    if (!step[edge.from]) step[edge.from] = near;
    sum += edge.from_from_to.translation -
           Vector3(static_cast<double>(near.x), static_cast<double>(near.y), 0.0);
    ++steps;
  }
  std::vector<GridPose> poses(graph.ids.size());
  for (std::size_t i = 1; i < poses.size(); ++i) {
    if (!step[i - 1]) {
      throw no_grid(0, fmt::format("no edge from {} to {}", graph.ids[i - 1], graph.ids[i]));
    }
    poses[i] = compose(poses[i - 1], *step[i - 1]);
  }
  for (std::size_t i = 0; i < graph.edges.size(); ++i) {
    const Edge& edge = graph.edges[i];
    if (compose(poses[edge.from], rounded(edge)) == poses[edge.to]) continue;
    throw no_grid(
        graph.lines[i],
        "this edge and the odometry, in whole metres and quarter turns, lead to different "
        "poses");
  }
  if (steps == graph.edges.size()) throw no_grid(0, "no closures confirm it");
  constexpr double kLargest = 0.05;  // [m]
  const double mean = steps > 0 ? sum.norm() / static_cast<double>(steps) : 0.0;
  if (mean > kLargest) {
    throw no_grid(0, fmt::format("rounding changes its steps by {:.2g} m on average", mean));
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

/// A keyframe chain as measured: one odometry edge between every two neighbours.
#pragma once

#include <vector>

#include "datasets/core/problem.hpp"

namespace loopbench {

/// Why the odometry is not a whole chain, or empty: edge i must join keyframes i and i + 1. O(n).
inline std::string chain_fault(const Problem& problem) {
  const std::size_t wanted = problem.keyframes.empty() ? 0 : problem.keyframes.size() - 1;
  if (problem.odometry.size() != wanted) {
    return "odometry has " + std::to_string(problem.odometry.size()) +
           " edges, a whole chain has " + std::to_string(wanted);
  }
  for (std::size_t i = 0; i < wanted; ++i) {
    const Edge& edge = problem.odometry[i];
    if (edge.from != i || edge.to != i + 1) {
      return "odometry edge " + std::to_string(i) + " does not join neighbours";
    }
  }
  return "";
}

/// Log(measured^-1 actual): how far two poses are from an edge, in its twist [rho; phi].
inline Twist edge_error(const Edge& edge, const Pose& from, const Pose& to) {
  return log_se3(edge.from_from_to.inverse() * (from.inverse() * to));
}

/// Half the information-weighted squares over odometry and closures: chi^2 / 2. O(edges).
inline double chain_cost(const Problem& problem, const std::vector<Pose>& poses) {
  double sum = 0.0;
  for (const std::vector<Edge>* edges : {&problem.odometry, &problem.closures}) {
    for (const Edge& edge : *edges) {
      const Twist e = edge_error(edge, poses[edge.from], poses[edge.to]);
      sum += e.dot(edge.information * e);
    }
  }
  return 0.5 * sum;
}

}  // namespace loopbench

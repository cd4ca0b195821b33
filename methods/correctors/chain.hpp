/// Properties of problems on which correctors depend: a chain of keyframes, rigid edges.
#pragma once

#include <algorithm>
#include <string>

#include "datasets/core/problem.hpp"

namespace loopbench::methods {

/// Returns why the odometry is not a complete chain, or an empty text. Edge i must join
/// keyframes i and i + 1. O(n).
inline std::string why_no_chain(const Problem& problem) {
  const std::size_t expected = problem.keyframes.empty() ? 0 : problem.keyframes.size() - 1;
  if (problem.odometry.size() != expected) {
    return "odometry has " + std::to_string(problem.odometry.size()) +
           " edges, a complete chain has " + std::to_string(expected);
  }
  for (std::size_t i = 0; i < expected; ++i) {
    const Edge& edge = problem.odometry[i];
    if (edge.from != i || edge.to != i + 1) {
      return "an odometry edge joins keyframes " + problem.name_of(edge.from) + " and " +
             problem.name_of(edge.to) + ", expected " + problem.name_of(i) + " and " +
             problem.name_of(i + 1);
    }
  }
  return "";
}

/// Returns why a chain cannot be corrected by at most `max_closures` loops and anchors, or an empty
/// text. O(n).
inline std::string loops_fault(const Problem& problem,
                               std::int64_t max_closures,
                               const std::string& option = "max_closures") {
  const std::size_t closures = problem.closures.size(), anchors = problem.anchors.size();
  if (closures + anchors == 0) return "the problem has no loop closures";
  if (closures + anchors > static_cast<std::size_t>(max_closures)) {
    return std::to_string(closures) + " closures " +
           (anchors > 0 ? "and " + std::to_string(anchors) + " anchors " : "") + "exceed " +
           option + " = " + std::to_string(max_closures);
  }
  return why_no_chain(problem);
}

/// False if the scale of the edge is unknown, as of closures where nothing shows it
/// (with_local_scale()). Without an information the scale has a default deviation.
inline bool states_scale(const Edge& edge) {
  constexpr double kLeast = 1e-5;  // of a deviation of 300 times
  return edge.scale_information == 0.0 || edge.scale_information > kLeast;
}

/// Whether an edge changes the scale, or leaves it open (a Sim(3) problem), as in monocular chains.
inline bool has_scale_drift(const Problem& problem) {
  const auto scaled = [](const Edge& edge) { return edge.scale != 1.0 || !states_scale(edge); };
  return std::ranges::any_of(problem.odometry, scaled) ||
         std::ranges::any_of(problem.closures, scaled);
}

/// Returns Log(measured^-1 (from^-1 to)), the residual of an edge as a twist [rho; phi].
inline Twist edge_error(const Edge& edge, const Pose& from, const Pose& to) {
  return log_se3(edge.from_from_to.inverse() * (from.inverse() * to));
}

}  // namespace loopbench::methods

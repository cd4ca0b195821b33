/// What a method is given, kept apart from what only the judge may see.
#pragma once

#include <Eigen/Cholesky>
#include <cstddef>
#include <string>
#include <tuple>
#include <vector>

#include "datasets/core/se3.hpp"
#include "datasets/core/trajectory.hpp"

namespace loopbench {

/// "Keyframe `to`, seen from keyframe `from`, is here": odometry or a loop closure.
struct Edge {
  std::size_t from = 0;
  std::size_t to = 0;
  Pose from_from_to;
  /// Inverse covariance of the twist e in `from_from_to * exp(e)`, order [rho; phi]. Units 1/m^2,
  /// 1/(m rad), 1/rad^2. Symmetric positive definite.
  Matrix6 information = Matrix6::Identity();
  double scale = 1.0;  ///< length unit of `to` over that of `from`; 1 unless the chain is Sim(3)
};

/// Everything a method may look at. The reference is deliberately not in here.
struct Problem {
  Trajectory keyframes;        ///< as the tracker left them
  std::vector<Edge> odometry;  ///< sorted by `from`; consecutive keyframes, from + 1 == to
  std::vector<Edge> closures;  ///< from < to, sorted by (to, from)
  Trajectory frames;           ///< tracked frames between keyframes, same world; may be empty
  bool planar = false;         ///< measured in SE(2), lifted to z = roll = pitch = 0
  /// Landmarks that keyframes k and k + 1 both see, one number a pair; empty when not known.
  std::vector<std::size_t> common_view = {};
};

/// Throws InputError naming `name` and the rule when edges or trajectories break their promise.
/// O(keyframes + frames + edges).
inline void check(const Problem& problem, const std::string& name) {
  check(problem.keyframes, name + ": keyframes");
  check(problem.frames, name + ": frames");
  if (!problem.common_view.empty() &&
      problem.common_view.size() + 1 != problem.keyframes.size()) {
    throw InputError(name + ": common_view has " + std::to_string(problem.common_view.size()) +
                     " counts, expected one for each pair of consecutive keyframes");
  }
  const auto check_edges = [&](const std::vector<Edge>& edges, const std::string& kind) {
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const Edge& edge = edges[i];
      const auto refuse = [&](const std::string& what) {
        return InputError(name + ": " + kind + " " + std::to_string(i) + ": " + what);
      };
      if (edge.from >= edge.to) throw refuse("from is not before to");
      if (edge.to >= problem.keyframes.size()) throw refuse("names no keyframe");
      if (!is_finite(edge.from_from_to) || !edge.information.allFinite() || !(edge.scale > 0.0)) {
        throw refuse("is not finite");
      }
      if (std::abs(edge.from_from_to.rotation.norm() - 1.0) > 1e-6) {
        throw refuse("quaternion is not unit");
      }
      const double largest = edge.information.cwiseAbs().maxCoeff();
      const Matrix6 skew = edge.information - edge.information.transpose();
      if (skew.cwiseAbs().maxCoeff() > 1e-9 * largest) throw refuse("information is not symmetric");
      if (edge.information.llt().info() != Eigen::Success) {
        throw refuse("information is not positive definite");
      }
    }
  };
  check_edges(problem.odometry, "odometry edge");
  check_edges(problem.closures, "closure");
  for (std::size_t i = 0; i < problem.odometry.size(); ++i) {
    const Edge& edge = problem.odometry[i];
    const std::string where = name + ": odometry edge " + std::to_string(i) + ": ";
    if (edge.to != edge.from + 1) throw InputError(where + "does not join consecutive keyframes");
    if (i > 0 && edge.from <= problem.odometry[i - 1].from) {
      throw InputError(where + "is not sorted by from");
    }
  }
  for (std::size_t i = 1; i < problem.closures.size(); ++i) {
    const Edge& before = problem.closures[i - 1];
    const Edge& edge = problem.closures[i];
    if (std::tie(edge.to, edge.from) < std::tie(before.to, before.from)) {
      throw InputError(name + ": closure " + std::to_string(i) + ": is not sorted by (to, from)");
    }
  }
}

}  // namespace loopbench

/// Input of a method: keyframes, odometry edges, loop closures and anchors, without the reference.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <tuple>
#include <vector>

#include "datasets/core/anchor.hpp"
#include "datasets/core/factorisations.hpp"
#include "datasets/core/params.hpp"
#include "datasets/core/pose_id.hpp"
#include "datasets/core/se3.hpp"
#include "datasets/core/trajectory.hpp"

namespace loopbench {

/// Relative pose measurement between two keyframes: odometry or a loop closure.
struct Edge {
  std::size_t from = 0;
  std::size_t to = 0;
  Pose from_from_to;
  /// Inverse covariance of the twist e in `from_from_to * exp(e)`, order [rho; phi]. Units 1/m^2,
  /// 1/(m rad), 1/rad^2. Symmetric positive definite.
  Matrix6 information = Matrix6::Identity();
  double scale = 1.0;  ///< scale of `to` relative to `from`; 1 unless the edges are Sim(3)
  /// Inverse variance of the logarithm of `scale` [-]; 0: not stated.
  double scale_information = 0.0;
};

/// All data available to a method. It does not contain the reference.
struct Problem {
  Trajectory keyframes;        ///< world_from_body as estimated by the tracker
  std::vector<Edge> odometry;  ///< between consecutive keyframes (from + 1 == to), sorted by `from`
  std::vector<Edge> closures;  ///< from < to, sorted by (to, from)
  Trajectory frames;           ///< tracked frames, in the world frame of `keyframes`; may be empty
  bool planar = false;         ///< all poses are in one plane, whose normal is the body's z axis
  /// Number of landmarks seen by both keyframes k and k + 1; empty if unknown.
  std::vector<std::size_t> shared_landmarks = {};
  /// Measured positions, sorted by keyframe. The keyframes may be in another world frame.
  std::vector<Anchor> anchors = {};
  std::vector<std::int64_t> ids = {};  ///< of the keyframes in their graph; empty: none

  /// For messages: the id of a graph (`a12` for a symbol of GTSAM), otherwise the stamp "12.5 s".
  std::string name_of(std::size_t keyframe) const {
    return ids.empty() ? to_text(keyframes[keyframe].stamp) + " s" : id_text(ids[keyframe]);
  }
};

/// Throws InputError with `name` and the violated rule if edges or trajectories are invalid.
/// O(keyframes + frames + edges + anchors).
inline void check(const Problem& problem, const std::string& name) {
  check(problem.keyframes, name + ": keyframes");
  check(problem.frames, name + ": frames");
  check(problem.anchors, problem.keyframes.size(), name);
  if (!problem.shared_landmarks.empty() &&
      problem.shared_landmarks.size() + 1 != problem.keyframes.size()) {
    throw InputError(name + ": shared_landmarks has " +
                     std::to_string(problem.shared_landmarks.size()) +
                     " counts, expected one for each pair of consecutive keyframes");
  }
  const auto check_edges = [&](const std::vector<Edge>& edges, const std::string& kind) {
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const Edge& edge = edges[i];
      const auto invalid = [&](const std::string& what) {
        return InputError(name + ": " + kind + " " + std::to_string(i) + ": " + what);
      };
      if (edge.from >= edge.to) throw invalid("from is not before to");
      if (edge.to >= problem.keyframes.size())
        throw invalid("refers to a keyframe that does not exist");
      if (!is_finite(edge.from_from_to) || !edge.information.allFinite() || !(edge.scale > 0.0)) {
        throw invalid("is not finite");
      }
      if (!(edge.scale_information >= 0.0) || !std::isfinite(edge.scale_information)) {
        throw invalid("information of the scale is negative or not finite");
      }
      if (std::abs(edge.from_from_to.rotation.norm() - 1.0) > 1e-6) {
        throw invalid("quaternion is not unit");
      }
      const double largest = edge.information.cwiseAbs().maxCoeff();
      const Matrix6 skew = edge.information - edge.information.transpose();
      if (skew.cwiseAbs().maxCoeff() > 1e-9 * largest)
        throw invalid("information is not symmetric");
      if (edge.information.llt().info() != Eigen::Success) {
        throw invalid("information is not positive definite");
      }
    }
  };
  check_edges(problem.odometry, "odometry edge");
  check_edges(problem.closures, "closure");
  for (std::size_t i = 0; i < problem.odometry.size(); ++i) {
    const Edge& edge = problem.odometry[i];
    const std::string where = name + ": odometry edge " + std::to_string(i) + ": ";
    if (edge.to != edge.from + 1)
      throw InputError(where + "does not connect consecutive keyframes");
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

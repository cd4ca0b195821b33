/// Mistakes in the edges of a pose graph that can be undone.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "datasets/core/pose.hpp"
#include "metrics/doctor/finding.hpp"

namespace loopbench::metrics {

/// What the other edges and the vertices say about an edge.
struct EdgeContext {
  Rotation predicted;  ///< rotation of from_from_to
  Pose world_from_from;
  Pose world_from_to;
};

using EdgeChange = std::function<Pose(const Pose& from_from_to, const EdgeContext&)>;

struct EdgeRepair {
  Fault::Name fault;
  std::string what;  ///< "inverting the odometry"
  std::string fix;
  EdgeChange change;
  double penalty = 0.0;             ///< logarithm of the number of alternatives
  double penalty_of_closure = 0.0;  ///< the same for each closure
  bool is_of_vertices = false;      ///< changes them as well as the edges
  double most_ratio = 0.6;          ///< of an error after the repair, over the one before
};

/// Changes nothing.
const EdgeRepair& as_read_edge();

/// Direction, order and unit of rotations, unit of translations, axes of the body or of the world.
const std::vector<EdgeRepair>& closure_repairs();

/// The same for odometry, or for all edges and vertices.
const std::vector<EdgeRepair>& odometry_repairs();

}  // namespace loopbench::metrics

/// Edges and anchors of one least-squares problem.
#pragma once

#include <cstddef>
#include <vector>

#include "datasets/core/anchor.hpp"
#include "datasets/core/problem.hpp"

namespace loopbench::methods {

struct WeightedGraph {
  std::size_t poses = 0;
  const std::vector<Edge>& odometry;
  const std::vector<Edge>& closures;
  const std::vector<double>& weights;  ///< of the closures; 0 removes one
  std::vector<Anchor> anchors;         ///< in the world of pose 0
  bool is_first_free = false;          ///< pose 0 is estimated
  double scale_sigma = 0.01;           ///< deviation of the log scale of an edge, Sim(3) only [-]

  /// Calls `visit` with each edge that is not removed, its weight and whether it is a closure.
  template <class Visit>
  void for_each_edge(Visit visit) const {
    for (const Edge& edge : odometry) visit(edge, 1.0, false);
    for (std::size_t k = 0; k < closures.size(); ++k) {
      if (weights[k] > 0.0) visit(closures[k], weights[k], true);
    }
  }
};

}  // namespace loopbench::methods

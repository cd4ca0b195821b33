/// Step 7: the cubic B-spline through all nodes, x'(t) and z'(t) of every window at once.
#pragma once

#include "methods/smoothers/manifold/nodes.hpp"

namespace loopbench::manifold {

/// Where the spline is: a position [m] and the way along the nodes [m].
struct Place {
  Vector3 point;
  double way;
};

/// The interpolating cubic B-spline with natural ends and time as its parameter. Held as values
/// and second derivatives at the nodes (the same function, cheaper to ask). One spline over the
/// whole trajectory: one for each segment would have no acceleration at every joint and could not
/// be C2 there. Coordinates in any fitting frame are linear in it, so frames share it.
/// Ends clamped to the optimal tangent psi will come in here.
class NodeSpline {
 public:
  explicit NodeSpline(const Nodes& nodes);  ///< two nodes or more; O(n)

  /// `time` in stamps[edge]..stamps[edge + 1]. O(1).
  Place at(std::size_t edge, double time) const;

  double way(std::size_t node) const { return knots_[node].value[3]; }

 private:
  using Value = Eigen::Vector4d;  ///< x, y, z and the way
  struct Knot {
    Value value;
    Value second;  ///< second derivative by time
  };

  std::vector<double> stamps_;
  std::vector<Knot> knots_;
};

}  // namespace loopbench::manifold

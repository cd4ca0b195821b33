/// Natural cubic spline through points in time.
#pragma once

#include <vector>

#include "datasets/core/so3.hpp"

namespace loopbench::metrics {

/// Twice differentiable, zero second derivative at both ends. Positions only.
/// Source: de Boor, A Practical Guide to Splines, ch. IV (second derivatives as unknowns).
class NaturalCubic {
 public:
  /// Needs at least two strictly increasing stamps and as many points. O(n).
  NaturalCubic(std::vector<double> stamps, std::vector<Vector3> points);

  /// Position at `time` [s], which lies in stamps[interval] .. stamps[interval + 1]. O(1).
  Vector3 at(std::size_t interval, double time) const;

 private:
  std::vector<double> stamps_;
  std::vector<Vector3> points_;
  std::vector<Vector3> second_derivatives_;  ///< second derivatives at the stamps [m/s^2]
};

}  // namespace loopbench::metrics

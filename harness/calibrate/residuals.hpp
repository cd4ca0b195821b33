/// What odometry got wrong, edge by edge, told by a reference.
#pragma once

#include <string>
#include <vector>

#include "datasets/core/sequence.hpp"
#include "methods/correctors/motion_drift/motion.hpp"

namespace loopbench {

struct EdgeResidual {
  std::array<double, kGrowths.size()> grown{};  ///< what the edge's error may grow with, by Growth
  Twist error;                                  ///< Log(measured^-1 true), at the edge's end
};

struct Residuals {
  std::string label;
  bool planar = false;  ///< only x, y and yaw are measured
  std::vector<EdgeResidual> edges;
};

/// `every` consecutive edges taken as one; a stretch with an end that the reference does not know
/// is left out. Throws InputError when the reference is empty or holds no attitude, or the
/// odometry is no chain. O(keyframes + reference).
Residuals residuals(const Sequence& sequence, const std::string& label, std::size_t every);

}  // namespace loopbench

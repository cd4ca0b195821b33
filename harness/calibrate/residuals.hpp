/// Odometry errors of single edges, from a reference.
#pragma once

#include <string>
#include <vector>

#include "datasets/core/sequence.hpp"
#include "methods/correctors/motion_drift/motion.hpp"

namespace loopbench::harness {

struct EdgeError {
  std::array<double, methods::kRegressors.size()>
      regressors{};  ///< regressors of the edge's error, by Regressor
  Twist error;       ///< Log(measured^-1 true), in the end frame
};

struct CalibrationResiduals {
  std::string label;
  bool planar = false;  ///< only x, y and yaw are measured
  std::vector<EdgeError> edges;
};

/// Combines `every` consecutive edges into one; skips groups with an end outside the reference.
/// Throws InputError if the reference is empty or has no orientations, or if the odometry is not a
/// chain. O(keyframes + reference).
CalibrationResiduals residuals(const Sequence& sequence,
                               const std::string& label,
                               std::size_t every);

}  // namespace loopbench::harness
